/* The targets of the device: those of surfaces, and the main target.
 *
 * A change of the target is a command of the queue, and so are the transfers between tiles and texels of
 * textures (render/target/surface.h). A call decides which transfers are needed, because the queue renders
 * in the order of the calls. Targets and transfers that commands refer to are released when the buffer of the
 * command is rendered. */
#include "render/device/device_part.h"

#include <stdlib.h>

/* --- Releasing --- */

/* Room for what the buffer that is filled will have referred to; null with the reason when memory is short.
 */
static struct released *make_released(struct error *error)
{
    struct released *released = calloc(1, sizeof *released);
    if (!released)
        error_set(error, "out of memory for a target");
    return released;
}

static void release_later(struct triptych_device *device, struct released *released)
{
    released->next = device->released;
    device->released = released;
}

void device_free_released(struct released *released)
{
    for (struct released *next; released; released = next) {
        next = released->next;
        if (released->target)
            target_destroy(released->target);
        free(released->target);
        surface_end_transfer(&released->transfer);
        free(released);
    }
}

/* --- Transfers --- */

static void set_newer(struct triptych_device *device, struct attachment *attachment, bool newer)
{
    device->binding.newer += (uint32_t)newer - (uint32_t)attachment->tiles_newer;
    attachment->tiles_newer = newer;
}

/* Transfers in the queue, or if memory is short immediately. */
static void transfer(struct triptych_device *device, const struct triptych_surface *surface, bool store)
{
    struct attachment *attachment = surface_attachment(surface);
    struct released *released = make_released(NULL);
    struct surface_transfer now, *made = released ? &released->transfer : &now;
    set_newer(device, attachment, false);
    attachment->texels_newer = false;
    surface_begin_transfer(surface, store, made);
    if (!released) {
        device_finish(device);
        queue_transfer(device->queue, &now);
        surface_end_transfer(&now);
        return;
    }
    struct command *command = device_next_command(device);
    command->kind = COMMAND_TRANSFER;
    command->transfer = made;
    device->queue->commands.count++;
    surface->texture->epoch = device->epoch;
    if (store)
        surface->texture->written = device->epoch;
    release_later(device, released);
}

/* Stores the texture's surfaces whose tiles are newer than the texels. */
void device_store_surfaces(struct triptych_device *device, struct triptych_texture *texture)
{
    for (struct drawn_surface *drawn = texture->drawn; drawn; drawn = drawn->next)
        if (drawn->attachment->tiles_newer) {
            struct triptych_surface surface = {texture, drawn->level, drawn->slice, NULL};
            transfer(device, &surface, true);
        }
}

void device_store_texture(struct triptych_device *device, struct triptych_texture *texture)
{
    device_store_surfaces(device, texture);
    if (device_uses(device, texture))
        device_finish(device);
}

void device_load_texture(struct triptych_device *device, struct triptych_texture *texture, unsigned first,
                         unsigned last)
{
    for (struct drawn_surface *drawn = texture->drawn; drawn; drawn = drawn->next)
        if (drawn->level >= first && drawn->level <= last)
            drawn->attachment->texels_newer = true;
    device->binding.stale |= device_draws_to(device, texture);
}

void device_load_surface(struct triptych_device *device, const struct triptych_surface *surface)
{
    struct attachment *attachment = surface_attachment(surface);
    struct surface_transfer now;
    surface_begin_transfer(surface, false, &now);
    queue_transfer(device->queue, &now);
    surface_end_transfer(&now);
    attachment->texels_newer = false;
}

void device_note_written(struct triptych_device *device, const struct triptych_surface *surface, bool tiles)
{
    struct attachment *attachment = surface_attachment(surface);
    if (tiles) {
        set_newer(device, attachment, true);
    } else if (attachment) {
        attachment->texels_newer = true;
        device->binding.stale |= device_draws_to(device, surface->texture);
    }
}

/* The surface that is a part of the target. */
static const struct triptych_surface *part_of(const struct triptych_device *device, unsigned part)
{
    const struct triptych_target_surfaces *surfaces = &device->binding.surfaces;
    return 1u << part == TARGET_DEPTH ? &surfaces->depth : &surfaces->color[part];
}

void device_load_target(struct triptych_device *device)
{
    for (unsigned part = 0; part <= TARGETS; part++)
        if (device->binding.textured >> part & 1 && surface_attachment(part_of(device, part))->texels_newer)
            transfer(device, part_of(device, part), false);
    device->binding.stale = false;
}

void device_finish_target(struct triptych_device *device)
{
    device_prepare_target(device);
    device_finish(device);
}

void device_note_newer(struct triptych_device *device, unsigned parts)
{
    for (; parts; parts &= parts - 1)
        set_newer(device, surface_attachment(part_of(device, (unsigned)__builtin_ctz(parts))), true);
}

void device_prepare_textures(struct triptych_device *device)
{
    for (int i = 0; i < SAMPLERS && device->binding.newer; i++)
        if (device->state.texture[i] && device->state.texture[i]->drawn &&
            device_derived_samples(&device->derived, i))
            device_store_surfaces(device, device->state.texture[i]);
    if (device->binding.newer && device_derived_masks(&device->derived))
        device_store_surfaces(device, device->state.clip_mask.texture);
}

/* --- The target --- */

bool device_draws_to(const struct triptych_device *device, const struct triptych_texture *texture)
{
    return device->binding.draws_to_surfaces && surfaces_include(&device->binding.surfaces, texture);
}

bool device_draws_to_image(const struct triptych_device *device, const struct triptych_image *image)
{
    return device->binding.draws_to_surfaces && surfaces_include_image(&device->binding.surfaces, image);
}

/* If nothing is queued, the target changes immediately. */
static void queue_target(struct triptych_device *device, struct target *target)
{
    if (!device_commands(device)) {
        queue_change_target(device->queue, target);
        return;
    }
    struct command *command = device_next_command(device);
    command->kind = COMMAND_TARGET;
    command->target = target;
    device->queue->commands.count++;
}

/* Queues the change to a target, which becomes the current one. `released` takes the one before if nothing
 * else has it. */
static void change_target(struct triptych_device *device, struct target *target, struct released *released)
{
    struct triptych_target_description description;
    struct device_binding *binding = &device->binding;
    queue_target(device, target);
    if (binding->draws_to_surfaces)
        released->target = binding->target;
    release_later(device, released);
    binding->target = target;
    binding->draws_to_surfaces = false;
    binding->textured = 0;
    binding->stale = false;
    target_describe(target, &description);
    state_set_target(&device->state, &description);
    device_state_changed(device, PARTS_ALL);
}

static enum triptych_result take_part(const struct triptych_surface *surface, struct attachment **part,
                                      struct error *error)
{
    struct error reason = {""};
    *part = surface_is_given(surface) ? surface_make_attachment(surface, &reason) : NULL;
    if (!reason.text[0])
        return TRIPTYCH_OK;
    error_set(error, "%s", reason.text);
    return TRIPTYCH_NO_MEMORY;
}

/* The attachments of the surfaces. Only depth that is the target's own is new. */
static enum triptych_result take_parts(const struct triptych_target_surfaces *surfaces,
                                       const struct triptych_target_description *description,
                                       struct target_parts *parts, struct error *error)
{
    enum triptych_result result = take_part(&surfaces->depth, &parts->depth, error);
    for (unsigned t = 0; t < TARGETS && result == TRIPTYCH_OK; t++)
        result = take_part(&surfaces->color[t], &parts->color[t], error);
    if (result != TRIPTYCH_OK || parts->depth || !depth_formats[description->depth_format].depth_bits)
        return result;
    parts->depth = attachment_create_depth(description->depth_format, description->width, description->height,
                                           description->samples ? description->samples : 1, error);
    return parts->depth ? TRIPTYCH_OK : TRIPTYCH_NO_MEMORY;
}

static struct target *bind_surfaces(const struct triptych_target_surfaces *surfaces,
                                    const struct triptych_target_description *description, bool quad_rows,
                                    struct error *error)
{
    struct target_parts parts = {.quad_rows = quad_rows};
    struct target *target = calloc(1, sizeof *target);
    if (!target)
        error_set(error, "out of memory for a target");
    bool bound = target && take_parts(surfaces, description, &parts, error) == TRIPTYCH_OK &&
                 !target_bind(target, description, &parts, error);
    if (!surface_is_given(&surfaces->depth))
        attachment_release(parts.depth);
    if (bound)
        return target;
    free(target);
    return NULL;
}

/* Finds the parts that are textures. */
static void note_textures(struct device_binding *binding)
{
    for (unsigned t = 0; t < TARGETS; t++)
        if (binding->surfaces.color[t].texture)
            binding->textured |= 1u << t;
    if (binding->surfaces.depth.texture)
        binding->textured |= TARGET_DEPTH;
    binding->stale = binding->textured;
}

static enum triptych_result draw_to_surfaces(struct triptych_device *device,
                                             const struct triptych_target_surfaces *surfaces,
                                             const struct triptych_target_description *description,
                                             struct error *error)
{
    struct released *released = make_released(error);
    bool quad_rows = device->resources.quad_rows;
    struct target *target = released ? bind_surfaces(surfaces, description, quad_rows, error) : NULL;
    if (!target) {
        free(released);
        return TRIPTYCH_NO_MEMORY;
    }
    change_target(device, target, released);
    device->binding.surfaces = *surfaces;
    device->binding.draws_to_surfaces = true;
    note_textures(&device->binding);
    return TRIPTYCH_OK;
}

enum triptych_result device_set_target_surfaces(struct triptych_device *device,
                                                const struct triptych_target_surfaces *surfaces,
                                                struct error *error)
{
    struct triptych_target_description description;
    if (!surfaces && !device->binding.draws_to_surfaces)
        return TRIPTYCH_OK;
    if (!surfaces) {
        struct released *released = make_released(error);
        if (!released)
            return TRIPTYCH_NO_MEMORY;
        change_target(device, device->binding.main, released);
        return TRIPTYCH_OK;
    }
    enum triptych_result result = surfaces_describe(surfaces, &description, error);
    if (result == TRIPTYCH_OK)
        result = device_check_target(&description, error);
    return result == TRIPTYCH_OK ? draw_to_surfaces(device, surfaces, &description, error) : result;
}

static void free_main(struct triptych_device *device, struct released *released)
{
    if (device->binding.main == &device->binding.none) {
        free(released);
        return;
    }
    released->target = device->binding.main;
    release_later(device, released);
}

enum triptych_result device_set_target(struct triptych_device *device,
                                       const struct triptych_target_description *description,
                                       struct error *error)
{
    enum triptych_result result = device_check_target(description, error);
    if (result != TRIPTYCH_OK)
        return result;
    struct released *released[2] = {make_released(error), make_released(error)};
    struct target *target = calloc(1, sizeof *target);
    if (!released[0] || !released[1] || !target ||
        target_create(target, description, device->resources.quad_rows, error)) {
        free(released[0]);
        free(released[1]);
        free(target);
        if (error && !error->text[0])
            error_set(error, "out of memory for a target");
        return TRIPTYCH_NO_MEMORY;
    }
    change_target(device, target, released[0]);
    free_main(device, released[1]);
    device->binding.main = target;
    return TRIPTYCH_OK;
}

static void order_attachment(struct attachment *attachment, bool quad_rows)
{
    if (attachment)
        attachment_memory_set_order(attachment->memory, quad_rows);
}

void device_order_targets(struct triptych_device *device, bool quad_rows)
{
    struct device_binding *binding = &device->binding;
    device_finish(device);
    for (struct triptych_image *image = device->resources.images; image; image = image->next)
        order_attachment(image->attachment, quad_rows);
    for (struct triptych_texture *texture = device->resources.textures; texture; texture = texture->next)
        for (struct drawn_surface *drawn = texture->drawn; drawn; drawn = drawn->next)
            order_attachment(drawn->attachment, quad_rows);
    target_set_order(binding->main, quad_rows);
    target_set_order(binding->target, quad_rows);
    device->resources.quad_rows = quad_rows;
}

void device_free_targets(struct triptych_device *device)
{
    struct device_binding *binding = &device->binding;
    device_free_released(device->released);
    device->released = NULL;
    if (binding->target != binding->main) {
        target_destroy(binding->target);
        free(binding->target);
    }
    if (binding->main != &binding->none) {
        target_destroy(binding->main);
        free(binding->main);
    }
}

/* --- Images --- */

enum triptych_result device_image_create(struct triptych_device *device,
                                         const struct triptych_image_description *description,
                                         struct triptych_image **result, struct error *error)
{
    enum triptych_result status = image_check(description, error);
    *result = NULL;
    if (status != TRIPTYCH_OK)
        return status;
    struct triptych_image *image = calloc(1, sizeof *image);
    uint32_t samples = description->samples ? description->samples : 1;
    const struct format *format = format_find(description->format);
    bool stored = description->format != TRIPTYCH_SURFACE_NULL;
    if (!image)
        error_set(error, "out of memory for an image");
    else if (stored && description->format)
        image->attachment =
            attachment_create_color(format, description->width, description->height, samples, error);
    else if (stored)
        image->attachment = attachment_create_depth(description->depth_format, description->width,
                                                    description->height, samples, error);
    if (!image || (stored && !image->attachment)) {
        free(image);
        return TRIPTYCH_NO_MEMORY;
    }
    image->description = *description;
    image->next = device->resources.images;
    device->resources.images = image;
    *result = image;
    return TRIPTYCH_OK;
}

enum triptych_result device_view(struct triptych_device *device, const struct triptych_surface *surface,
                                 struct target *view, struct error *error)
{
    struct triptych_target_description main, description = {.width = 0};
    struct target_parts parts = {.quad_rows = device->resources.quad_rows};
    if (surface->image) {
        const struct triptych_image_description *d = &surface->image->description;
        description = (struct triptych_target_description){d->width,
                                                           d->height,
                                                           d->format ? TRIPTYCH_DEPTH_NONE : d->depth_format,
                                                           {d->format ? d->format : TRIPTYCH_SURFACE_NULL},
                                                           d->samples};
        *(d->format ? &parts.color[0] : &parts.depth) = surface->image->attachment;
    } else if (surface->texture) {
        const struct attachment *a = surface_attachment(surface);
        description = (struct triptych_target_description){
            a->width, a->height, a->depth_format, {TRIPTYCH_SURFACE_NULL}, 1};
        *(a->format ? &parts.color[0] : &parts.depth) = surface_attachment(surface);
        if (a->format)
            description.color_format[0] = (enum triptych_surface_format)a->format->number;
        if (a->format)
            description.depth_format = TRIPTYCH_DEPTH_NONE;
    } else {
        target_describe(device->binding.main, &main);
        description = (struct triptych_target_description){
            main.width, main.height, TRIPTYCH_DEPTH_NONE, {main.color_format[surface->slice]}, main.samples};
        parts.color[0] = device->binding.main->colors[surface->slice].attachment;
    }
    return target_bind(view, &description, &parts, error) ? TRIPTYCH_NO_MEMORY : TRIPTYCH_OK;
}
