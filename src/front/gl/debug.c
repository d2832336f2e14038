/* Rules decide whether a message is received: of those that fit it, the last one counts. A group ends with
 * the rules that were added in it. */
#include "front/gl/debug.h"
#include "front/gl/commands.h"
#include "front/gl/constant.h"
#include "front/gl/fixed.h"
#include "front/gl/state.h"

#include <stdlib.h>
#include <string.h>

struct message {
    GLenum source, type, severity;
    GLuint id;
    char *text;
};

/* GL_DONT_CARE fits every value. */
struct rule {
    GLenum source, type, severity;
    GLuint id;
    bool one; /* it is for `id`, not for all messages */
    bool enabled;
};

struct group {
    GLenum source;
    GLuint id;
    unsigned rules; /* before it began */
    char *text;
};

struct gl_debug {
    GLDEBUGPROCKHR callback;
    const void *user;
    struct message log[GL_DEBUG_LOGGED];
    unsigned first, logged;
    struct rule *rule;
    unsigned rules, room;
    struct group group[GL_DEBUG_GROUPS];
    unsigned groups;
    char *marker[GL_DEBUG_GROUPS]; /* of groups of EXT_debug_marker */
    unsigned markers;              /* open groups; those that have no place have no text */
};

static struct gl_debug *debug_of(struct gl_context *context)
{
    if (!context->debug)
        context->debug = calloc(1, sizeof *context->debug);
    if (!context->debug)
        context->error = context->error == GL_NO_ERROR ? GL_OUT_OF_MEMORY : context->error;
    return context->debug;
}

void gl_debug_free(struct gl_context *context)
{
    struct gl_debug *debug = context->debug;
    if (!debug)
        return;
    for (unsigned i = 0; i < GL_DEBUG_LOGGED; i++)
        free(debug->log[i].text);
    for (unsigned i = 0; i < debug->groups; i++)
        free(debug->group[i].text);
    for (unsigned i = 0; i < GL_DEBUG_GROUPS; i++)
        free(debug->marker[i]);
    free(debug->rule);
    free(debug);
    context->debug = NULL;
}

/* --- Messages --- */

static bool fits(GLenum rule, GLenum value)
{
    return rule == GL_DONT_CARE || rule == value;
}

static bool is_enabled(const struct gl_debug *debug, const struct message *message)
{
    bool enabled = message->severity != GL_DEBUG_SEVERITY_LOW_KHR;
    for (unsigned i = 0; i < debug->rules; i++) {
        const struct rule *rule = debug->rule + i;
        if (fits(rule->source, message->source) && fits(rule->type, message->type) &&
            fits(rule->severity, message->severity) && (!rule->one || rule->id == message->id))
            enabled = rule->enabled;
    }
    return enabled;
}

/* A full log drops new messages. */
static void log_message(struct gl_debug *debug, const struct message *message)
{
    if (debug->logged == GL_DEBUG_LOGGED)
        return;
    struct message *to = debug->log + (debug->first + debug->logged) % GL_DEBUG_LOGGED;
    *to = *message;
    to->text = strdup(message->text);
    debug->logged += to->text != NULL;
}

static void send(struct gl_context *context, const struct message *message)
{
    struct gl_debug *debug = debug_of(context);
    if (!debug || !context->values.debug_output[0] || !is_enabled(debug, message))
        return;
    if (debug->callback)
        debug->callback(message->source, message->type, message->id, message->severity,
                        (GLsizei)strlen(message->text), message->text, debug->user);
    else
        log_message(debug, message);
}

bool gl_debug_wants(const struct gl_context *context, GLenum type)
{
    (void)type;
    return context->values.debug_output[0];
}

void gl_debug_message(struct gl_context *context, GLenum type, GLuint id, GLenum severity, const char *text)
{
    send(context, &(struct message){GL_DEBUG_SOURCE_API_KHR, type, severity, id, (char *)text});
}

int32_t gl_debug_logged(const struct gl_context *context)
{
    return context->debug ? (int32_t)context->debug->logged : 0;
}

int32_t gl_debug_next_length(const struct gl_context *context)
{
    const struct gl_debug *debug = context->debug;
    return debug && debug->logged ? (int32_t)strlen(debug->log[debug->first].text) + 1 : 0;
}

int32_t gl_debug_depth(const struct gl_context *context)
{
    return context->debug ? (int32_t)context->debug->groups + 1 : 1;
}

/* --- Commands --- */

static bool is_source(GLenum source, bool any)
{
    return (source >= GL_DEBUG_SOURCE_API_KHR && source <= GL_DEBUG_SOURCE_OTHER_KHR && any) ||
           source == GL_DEBUG_SOURCE_APPLICATION_KHR || source == GL_DEBUG_SOURCE_THIRD_PARTY_KHR;
}

static bool is_type(GLenum type)
{
    return (type >= GL_DEBUG_TYPE_ERROR_KHR && type <= GL_DEBUG_TYPE_OTHER_KHR) ||
           (type >= GL_DEBUG_TYPE_MARKER_KHR && type <= GL_DEBUG_TYPE_POP_GROUP_KHR);
}

static bool is_severity(GLenum severity)
{
    return (severity >= GL_DEBUG_SEVERITY_HIGH_KHR && severity <= GL_DEBUG_SEVERITY_LOW_KHR) ||
           severity == GL_DEBUG_SEVERITY_NOTIFICATION_KHR;
}

static bool refuse(struct gl_context *context, GLenum found, const char *expected)
{
    gl_error(context, GL_INVALID_ENUM, "found %s, expected %s", gl_constant_name(found), expected);
    return false;
}

/* Returns the bytes of a text without its zero; -1 with an error if it is too long. */
static int text_bytes(struct gl_context *context, GLsizei length, const char *text)
{
    size_t bytes = length < 0 ? strlen(text) : (size_t)length;
    if (bytes < GL_DEBUG_TEXT)
        return (int)bytes;
    gl_error(context, GL_INVALID_VALUE, "found a text of %zu bytes, expected less than %d", bytes,
             GL_DEBUG_TEXT);
    return -1;
}

void gl_DebugMessageCallbackKHR(struct gl_context *context, GLDEBUGPROCKHR callback, const void *user)
{
    struct gl_debug *debug = debug_of(context);
    if (!debug)
        return;
    debug->callback = callback;
    debug->user = user;
}

static bool check_control(struct gl_context *context, const struct rule *rule, GLsizei count)
{
    if (rule->source != GL_DONT_CARE && !is_source(rule->source, true))
        return refuse(context, rule->source, "a source of messages");
    if (rule->type != GL_DONT_CARE && !is_type(rule->type))
        return refuse(context, rule->type, "a type of messages");
    if (rule->severity != GL_DONT_CARE && !is_severity(rule->severity))
        return refuse(context, rule->severity, "a severity");
    if (count < 0)
        gl_error(context, GL_INVALID_VALUE, "found %d identifiers, expected 0 or more", count);
    else if (count &&
             (rule->source == GL_DONT_CARE || rule->type == GL_DONT_CARE || rule->severity != GL_DONT_CARE))
        gl_error(context, GL_INVALID_OPERATION, "identifiers need a source and a type, and any severity");
    else
        return true;
    return false;
}

static void add_rule(struct gl_context *context, struct gl_debug *debug, const struct rule *rule)
{
    if (debug->rules == debug->room) {
        unsigned room = debug->room ? debug->room * 2 : 16;
        struct rule *larger = room < 1u << 20 ? realloc(debug->rule, room * sizeof *larger) : NULL;
        if (!larger) {
            gl_error(context, GL_OUT_OF_MEMORY, "no memory for rules of messages");
            return;
        }
        debug->rule = larger;
        debug->room = room;
    }
    debug->rule[debug->rules++] = *rule;
}

void gl_DebugMessageControlKHR(struct gl_context *context, GLenum source, GLenum type, GLenum severity,
                               GLsizei count, const GLuint *ids, GLboolean enabled)
{
    struct gl_debug *debug = debug_of(context);
    struct rule rule = {source, type, severity, .enabled = enabled, .one = count > 0};
    if (!debug || !check_control(context, &rule, count))
        return;
    if (!count)
        add_rule(context, debug, &rule);
    for (GLsizei i = 0; i < count; i++) {
        rule.id = ids[i];
        add_rule(context, debug, &rule);
    }
}

void gl_DebugMessageInsertKHR(struct gl_context *context, GLenum source, GLenum type, GLuint id,
                              GLenum severity, GLsizei length, const GLchar *text)
{
    char copy[GL_DEBUG_TEXT];
    if (!is_source(source, false)) {
        refuse(context, source, "a source of programs");
        return;
    }
    if (!is_type(type) || !is_severity(severity)) {
        refuse(context, is_type(type) ? severity : type, "a type and a severity of messages");
        return;
    }
    int bytes = text_bytes(context, length, text);
    if (bytes < 0)
        return;
    memcpy(copy, text, (size_t)bytes);
    copy[bytes] = 0;
    send(context, &(struct message){source, type, severity, id, copy});
}

GLuint gl_GetDebugMessageLogKHR(struct gl_context *context, GLuint count, GLsizei room, GLenum *sources,
                                GLenum *types, GLuint *ids, GLenum *severities, GLsizei *lengths, GLchar *out)
{
    struct gl_debug *debug = context->debug;
    GLuint n = 0;
    if (room < 0 && out)
        gl_error(context, GL_INVALID_VALUE, "found a size of %d, expected 0 or more", room);
    for (; debug && (room >= 0 || !out) && n < count && debug->logged; n++) {
        struct message *message = debug->log + debug->first;
        GLsizei bytes = (GLsizei)strlen(message->text) + 1;
        if (out && bytes > room)
            break;
        if (out)
            out = (GLchar *)memcpy(out, message->text, (size_t)bytes) + bytes, room -= bytes;
        if (sources)
            sources[n] = message->source;
        if (types)
            types[n] = message->type;
        if (ids)
            ids[n] = message->id;
        if (severities)
            severities[n] = message->severity;
        if (lengths)
            lengths[n] = bytes;
        free(message->text);
        message->text = NULL;
        debug->first = (debug->first + 1) % GL_DEBUG_LOGGED;
        debug->logged--;
    }
    return n;
}

void gl_PushDebugGroupKHR(struct gl_context *context, GLenum source, GLuint id, GLsizei length,
                          const GLchar *text)
{
    struct gl_debug *debug = debug_of(context);
    if (!is_source(source, false)) {
        refuse(context, source, "a source of programs");
        return;
    }
    int bytes = text_bytes(context, length, text);
    if (!debug || bytes < 0)
        return;
    if (debug->groups == GL_DEBUG_GROUPS - 1) {
        gl_error(context, GL_STACK_OVERFLOW_KHR, "%d groups are open", GL_DEBUG_GROUPS);
        return;
    }
    struct group group = {source, id, debug->rules, strndup(text, (size_t)bytes)};
    if (!group.text) {
        gl_error(context, GL_OUT_OF_MEMORY, "no memory for a group");
        return;
    }
    send(context, &(struct message){source, GL_DEBUG_TYPE_PUSH_GROUP_KHR, GL_DEBUG_SEVERITY_NOTIFICATION_KHR,
                                    id, group.text});
    debug->group[debug->groups++] = group;
}

void gl_PopDebugGroupKHR(struct gl_context *context)
{
    struct gl_debug *debug = context->debug;
    if (!debug || !debug->groups) {
        gl_error(context, GL_STACK_UNDERFLOW_KHR, "no group is open");
        return;
    }
    struct group *group = debug->group + --debug->groups;
    debug->rules = group->rules;
    send(context, &(struct message){group->source, GL_DEBUG_TYPE_POP_GROUP_KHR,
                                    GL_DEBUG_SEVERITY_NOTIFICATION_KHR, group->id, group->text});
    free(group->text);
    *group = (struct group){0};
}

/* --- EXT_debug_marker --- */

/* The most bytes of a text. A length of 0 is that of a text that ends with 0. */
static size_t marker_most(GLsizei length)
{
    return length && length < GL_DEBUG_TEXT ? (size_t)length : GL_DEBUG_TEXT - 1;
}

/* Markers are messages too, and never errors: a text that is too long is cut, and one of a negative length is
 * ignored. */
static bool send_marker(struct gl_context *context, GLenum type, GLsizei length, const GLchar *text)
{
    char copy[GL_DEBUG_TEXT] = "";
    if (length < 0 || !debug_of(context))
        return false;
    if (text)
        memcpy(copy, text, strnlen(text, marker_most(length)));
    send(context, &(struct message){GL_DEBUG_SOURCE_APPLICATION_KHR, type, GL_DEBUG_SEVERITY_NOTIFICATION_KHR,
                                    0, copy});
    return true;
}

void gl_InsertEventMarkerEXT(struct gl_context *context, GLsizei length, const GLchar *text)
{
    send_marker(context, GL_DEBUG_TYPE_MARKER_KHR, length, text);
}

void gl_PushGroupMarkerEXT(struct gl_context *context, GLsizei length, const GLchar *text)
{
    struct gl_debug *debug;
    if (!send_marker(context, GL_DEBUG_TYPE_PUSH_GROUP_KHR, length, text))
        return;
    debug = context->debug;
    if (debug->markers < GL_DEBUG_GROUPS)
        debug->marker[debug->markers] = text ? strndup(text, marker_most(length)) : NULL;
    debug->markers += debug->markers < UINT32_MAX;
}

void gl_PopGroupMarkerEXT(struct gl_context *context)
{
    struct gl_debug *debug = context->debug;
    if (!debug || !debug->markers)
        return;
    unsigned i = --debug->markers;
    char *text = i < GL_DEBUG_GROUPS ? debug->marker[i] : NULL;
    send_marker(context, GL_DEBUG_TYPE_POP_GROUP_KHR, 0, text);
    free(text);
    if (i < GL_DEBUG_GROUPS)
        debug->marker[i] = NULL;
}

void gl_GetPointerv(struct gl_context *context, GLenum name, void **out)
{
    const struct gl_debug *debug = context->debug;
    if (name == GL_DEBUG_CALLBACK_FUNCTION_KHR)
        *out = debug ? *(void *const *)&debug->callback : NULL;
    else if (name == GL_DEBUG_CALLBACK_USER_PARAM_KHR)
        *out = debug ? (void *)debug->user : NULL;
    else if (!context->fixed || !gl_fixed_pointer(context, name, out))
        refuse(context, name, "a pointer");
}
