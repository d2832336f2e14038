/* Recording: the calls of a device written to a container while they run (triptych_record_start).
 *
 * Each public function that has succeeded, and that pictures depend on, becomes the call of a stream that does the same
 * when it is played (call.h); memory of the caller is copied at once. What a stream cannot say the same way is said
 * another way: the contents of an update are a buffer that lives for one call, attributes that no draw reads and that
 * do not lie in their buffers are undeclared for the draw, a query that outlives its frame is one of each frame.
 *
 * A recording that starts late begins with the resources that are alive, their contents, those of the targets, and the
 * state as far as it is not that in which streams begin (record_start.c). triptych_finish ends a frame.
 *
 * A failure to write is kept, and told when the recording is stopped; calls go on as if nothing was recorded. */
#ifndef CONTAINER_RECORD_H
#define CONTAINER_RECORD_H

#include "container/call.h"
#include "draw/device.h"

struct recorder;

/* Begins and ends. The device has a recorder between them; stopping renders nothing and ends it whatever happens. */
enum triptych_result record_start(struct triptych_device *device, const char *path, struct error *error);
enum triptych_result record_stop(struct triptych_device *device, struct error *error);

/* Begins the recording that the environment asks for of a new device, if it does. */
enum triptych_result record_from_environment(struct triptych_device *device, struct error *error);

/* --- Calls (record_call.c), behind what they record; nothing happens without a recorder ---------------------
 */

void record_target(struct triptych_device *device, const struct triptych_target_description *description);
void record_attach(struct triptych_device *device, const struct triptych_target_textures *textures);
void record_copy(struct triptych_device *device, const struct surface_copy *copy);
void record_viewport(struct triptych_device *device, const struct triptych_viewport *viewport);
void record_scissor(struct triptych_device *device, unsigned x, unsigned y, unsigned width, unsigned height);
void record_value(struct triptych_device *device, enum triptych_state_table table, unsigned i, unsigned row,
                  uint32_t value);
void record_convention(struct triptych_device *device, enum triptych_convention which, unsigned value);
void record_clip_plane(struct triptych_device *device, unsigned i, const float plane[4]);
void record_transform(struct triptych_device *device, enum triptych_transform which,
                      const float matrix[4][4]);
void record_material(struct triptych_device *device, const struct triptych_material *material);
void record_light(struct triptych_device *device, unsigned index, const struct triptych_light *light);
void record_enable_light(struct triptych_device *device, unsigned index, int on);
void record_bind_texture(struct triptych_device *device, unsigned sampler, const triptych_texture *texture);
void record_element(struct triptych_device *device, enum triptych_attribute attribute,
                    const struct triptych_element *element);
void record_declaration(struct triptych_device *device, const struct triptych_declaration_element *elements,
                        unsigned count);
void record_fvf(struct triptych_device *device, uint32_t fvf);
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
void record_clear(struct triptych_device *device, const struct clear_values *values);
void record_draw(struct triptych_device *device, enum triptych_primitive primitive, uint32_t first,
                 uint32_t count);
void record_draw_indexed(struct triptych_device *device, enum triptych_primitive primitive, int32_t base,
                         uint32_t first, uint32_t count);
void record_update(struct triptych_device *device, const triptych_texture *texture, unsigned face,
                   unsigned level, const struct triptych_box *box, const void *data, size_t row_pitch,
                   size_t slice_pitch);
void record_mips(struct triptych_device *device, const triptych_texture *texture);
void record_texels(struct triptych_device *device, const triptych_texture *texture, const void *data,
                   size_t bytes);
void record_contents(struct triptych_device *device, const void *data, size_t bytes);
void record_query(struct triptych_device *device, triptych_query *query, int begin);
void record_frame(struct triptych_device *device);

/* Resources: new ones; and those that are about to be destroyed, which the recorder looks for among the device's. */
void record_new_buffer(struct triptych_device *device, triptych_buffer *buffer);
void record_new_texture(struct triptych_device *device, triptych_texture *texture);
void record_new_shader(struct triptych_device *device, triptych_shader *shader);
void record_new_query(struct triptych_device *device, triptych_query *query);
void record_end_buffer(struct triptych_device *device, const triptych_buffer *buffer);
void record_end_texture(struct triptych_device *device, const triptych_texture *texture);
void record_end_shader(struct triptych_device *device, const triptych_shader *shader);
void record_end_query(struct triptych_device *device, const triptych_query *query);

#endif
