#include "queue.h"
#include "known.h"
#include "packing.h"

/* A server that sleeps is woken when it has this many messages, or when the client waits for it. */
enum { DUE = 64 };

static uint8_t *first_place(const struct d3d9_queue *queue)
{
    return (uint8_t *)queue->channel + D3D9_CHANNEL_HEADER;
}

void d3d9_queue_begin(struct d3d9_queue *queue, struct d3d9_channel *channel,
                      int (*send)(void *context, bool wait), void *context)
{
    *queue = (struct d3d9_queue){.channel = channel, .send = send, .context = context};
    queue->at = first_place(queue);
}

/* Waits until all messages are executed; their memory is free again. */
static int wait(struct d3d9_queue *queue)
{
    if (queue->send(queue->context, true))
        return -1;
    queue->at = first_place(queue);
    return 0;
}

/* Returns the shared block; null without room. */
static void *try_put(struct d3d9_queue *queue, unsigned code, const void *block)
{
    struct d3d9_channel *channel = queue->channel;
    struct d3d9_packing packing = {queue->at, (uint8_t *)channel + D3D9_CHANNEL_ARENA, false};
    uint32_t sent = channel->sent;
    if (sent - channel->done >= D3D9_CHANNEL_MESSAGES)
        return NULL;
    void *shared = d3d9_pack(&packing, code, block);
    if (!shared)
        return NULL;
    queue->at = packing.at;
    channel->message[sent % D3D9_CHANNEL_MESSAGES] = (struct d3d9_message){code, (uint32_t)(uintptr_t)shared};
    channel->sent = sent + 1;
    return shared;
}

/* Without room it waits for the server, whose end is a failure. */
static void *put(struct d3d9_queue *queue, unsigned code, void *block)
{
    void *shared = try_put(queue, code, block);
    if (shared)
        return shared;
    if (wait(queue)) {
        d3d9_pack_result(code, block, D3D9_DEVICE_LOST);
        return NULL;
    }
    shared = try_put(queue, code, block);
    if (!shared)
        d3d9_pack_result(code, block, D3D9_OUT_OF_MEMORY);
    return shared;
}

int d3d9_queue_call(struct d3d9_queue *queue, unsigned code, void *block)
{
    struct d3d9_channel *channel = queue->channel;
    if (d3d9_known_count(code, block))
        return D3D9_DONE;
    bool known = d3d9_known(code, block);
    void *shared = put(queue, code, block);
    if (!shared)
        return D3D9_DONE;
    if (known) {
        d3d9_pack_result(code, block, D3D9_OK);
        if (channel->server_sleeps && channel->sent - channel->done >= DUE)
            queue->send(queue->context, false);
        return D3D9_DONE;
    }
    if (queue->send(queue->context, true)) {
        d3d9_pack_result(code, block, D3D9_DEVICE_LOST);
        return D3D9_DONE;
    }
    d3d9_unpack(code, block, shared);
    queue->at = first_place(queue);
    return channel->result;
}
