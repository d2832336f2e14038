/* Recording: writes the calls of a device to a container while they run (triptych_record_start).
 *
 * Each successful public function that affects pictures is written as the call of a stream with the same
 * effect (call.h). Memory of the caller is copied immediately. Some calls have no direct equivalent in a
 * stream:
 * - The contents of an update are a buffer that exists for one call.
 * - Attributes that a draw does not read, and that exceed their buffers, are not declared during the draw.
 * - A query that spans frames becomes one query in each frame.
 *
 * A recording that starts late begins with the existing resources, their contents, the contents of the
 * targets, and all state that differs from the initial state of streams (record_start.c). triptych_end_frame
 * ends a frame. A recording that waited for pixels several times without it is reported as a warning.
 *
 * A failure to write is reported when the recording stops. Until then calls are executed as without a
 * recording. */
#ifndef CAPTURE_RECORD_H
#define CAPTURE_RECORD_H

#include "capture/call.h"
#include "render/device/device.h"

struct recorder;

/* Begin and end a recording. The device has a recorder in between. Stopping renders nothing, and ends the
 * recording also if it fails. */
enum triptych_result record_start(struct triptych_device *device, const char *path, struct error *error);
enum triptych_result record_stop(struct triptych_device *device, struct error *error);

/* Ends the recording of a device before its destruction. A failure is reported to the log. */
void record_close(struct triptych_device *device);

/* Begins the recording of a new device if the environment variable TRIPTYCH_RECORD is set. */
enum triptych_result record_from_environment(struct triptych_device *device, struct error *error);

/* --- The state ------------------------------------------------------------------------------------------ */

/* Visits the calls that change the initial state of streams into that of the device: states, transforms, clip
 * planes, conventions, material, lights, constants of shaders, each in the order of its numbers. Targets,
 * viewport, scissor rectangle and all bindings are left out, because they name resources or depend on the
 * target.
 *
 * Streams begin with the default of each state, identity transforms, zeros in constants and clip planes, the
 * material and the lights call_default_..., and no bindings (docs/streams.md, Frames). */
typedef void record_visitor(void *user, const struct call *call);
void record_differences(const struct triptych_device *device, record_visitor *visit, void *user);

/* --- Calls ---------------------------------------------------------------------------------------------- */

/* Each is called after the device has executed the call. Without a recorder it does nothing. */

/* Writes a call as it is: one that needs no translation (call.def). */
void record_call(struct triptych_device *device, const struct call *call);

/* Calls that are translated. */

void record_target(struct triptych_device *device, const struct triptych_target_description *description);
void record_attach(struct triptych_device *device, const struct triptych_target_surfaces *surfaces);
void record_copy(struct triptych_device *device, const struct surface_copy *copy);
void record_write_rectangle(struct triptych_device *device, const struct triptych_surface *surface,
                            const struct surface_memory *memory, const void *data, size_t pitch);
void record_fill(struct triptych_device *device, const struct triptych_surface *surface,
                 const struct triptych_rectangle *part, const float color[4]);
void record_viewport(struct triptych_device *device, const struct triptych_viewport *viewport);
void record_scissor(struct triptych_device *device, unsigned x, unsigned y, unsigned width, unsigned height);
void record_value(struct triptych_device *device, enum triptych_state_table table, unsigned i, unsigned row,
                  uint32_t value);
void record_convention(struct triptych_device *device, enum triptych_convention which, unsigned value);
void record_clip_mask(struct triptych_device *device, const struct triptych_clip_mask *mask);
void record_clip_plane(struct triptych_device *device, unsigned i, const float plane[4]);
void record_transform(struct triptych_device *device, enum triptych_transform which,
                      const float matrix[4][4]);
void record_material(struct triptych_device *device, const struct triptych_material *material);
void record_light(struct triptych_device *device, unsigned index, const struct triptych_light *light);
void record_enable_light(struct triptych_device *device, unsigned index, bool on);
void record_bind_texture(struct triptych_device *device, unsigned sampler, const triptych_texture *texture);
void record_element(struct triptych_device *device, enum triptych_attribute attribute,
                    const struct triptych_element *element);
void record_declaration(struct triptych_device *device, const struct triptych_declaration_element *elements,
                        unsigned count);
void record_stream(struct triptych_device *device, unsigned stream, const triptych_buffer *buffer,
                   size_t offset, size_t stride);
void record_frequency(struct triptych_device *device, unsigned stream, enum triptych_frequency frequency,
                      uint32_t count);
void record_indices(struct triptych_device *device, const triptych_buffer *buffer, unsigned bits);
void record_shader(struct triptych_device *device, enum shader_stage stage, const triptych_shader *shader);
void record_floats(struct triptych_device *device, enum triptych_shader_stage stage, unsigned first,
                   const float *values, unsigned count);
void record_integers(struct triptych_device *device, enum triptych_shader_stage stage, unsigned first,
                     const int32_t *values, unsigned count);
void record_booleans(struct triptych_device *device, enum triptych_shader_stage stage, unsigned first,
                     const int32_t *values, unsigned count);
void record_clear(struct triptych_device *device, const struct triptych_clear_values *values,
                  const struct triptych_rectangle *rectangles, unsigned count);
void record_draw(struct triptych_device *device, enum triptych_primitive primitive, uint32_t first,
                 uint32_t count);
void record_draw_indexed(struct triptych_device *device, enum triptych_primitive primitive, int32_t base,
                         uint32_t first, uint32_t count);
void record_draw_user(struct triptych_device *device, const struct user_draw *draw);
/* Bytes of a buffer that the application has written. */
void record_write(struct triptych_device *device, const triptych_buffer *buffer, struct buffer_span span);
/* All bytes become 0. */
void record_discard(struct triptych_device *device, const triptych_buffer *buffer);
/* The bytes that the application may have written in a mapped buffer. */
void record_mapped(struct triptych_device *device, const triptych_buffer *buffer);
void record_update(struct triptych_device *device, const triptych_texture *texture, unsigned face,
                   unsigned level, const struct triptych_box *box, const void *data, size_t row_pitch,
                   size_t slice_pitch);
void record_texels(struct triptych_device *device, const triptych_texture *texture, const void *data,
                   size_t bytes);
void record_contents(struct triptych_device *device, const void *data, size_t bytes);
void record_query(struct triptych_device *device, triptych_query *query, int begin);
void record_frame(struct triptych_device *device);
/* The application has waited for what it drew: read pixels or finished rendering. */
void record_wait(struct triptych_device *device);

/* New resources, and resources before their destruction. The latter are ignored if the device does not have
 * them. */
void record_new_buffer(struct triptych_device *device, triptych_buffer *buffer);
void record_new_texture(struct triptych_device *device, triptych_texture *texture);
void record_new_image(struct triptych_device *device, triptych_image *image);
void record_new_shader(struct triptych_device *device, triptych_shader *shader);
void record_new_query(struct triptych_device *device, triptych_query *query);
void record_end_buffer(struct triptych_device *device, const triptych_buffer *buffer);
void record_end_texture(struct triptych_device *device, const triptych_texture *texture);
void record_end_image(struct triptych_device *device, const triptych_image *image);
void record_end_shader(struct triptych_device *device, const triptych_shader *shader);
void record_end_query(struct triptych_device *device, const triptych_query *query);

#endif
