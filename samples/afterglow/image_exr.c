// SPDX-License-Identifier: MIT
#include "image_priv.h"

#include <errno.h>
#include <openexr.h>
#include <string.h>
#include <unistd.h>

// The library's stream over an open file. `why` gets its first complaint, which is the cause;
// the later ones are consequences.
typedef struct exr_stream {
    int fd;
    int64_t size;
    char *why;
} exr_stream;

static const char *const channel_names[3] = { "R", "G", "B" };

// Writing contexts report errors with their lock held, which exr_get_user_data() would wait for.
static void stay_silent(exr_const_context_t ctxt, exr_result_t code, const char *msg)
{
    (void) ctxt;
    (void) code;
    (void) msg;
}

static void on_read_error(exr_const_context_t ctxt, exr_result_t code, const char *msg)
{
    void *user = NULL;
    (void) code;
    if (!ctxt || exr_get_user_data(ctxt, &user) != EXR_ERR_SUCCESS || !user)
        return;
    const exr_stream *stream = user;
    if (!stream->why[0])
        snprintf(stream->why, IMAGE_WHY, "%s", msg);
}

static int64_t stream_size(exr_const_context_t ctxt, void *user)
{
    (void) ctxt;
    return ((const exr_stream *) user)->size;
}

static int64_t stream_read(exr_const_context_t ctxt, void *user, void *buffer, uint64_t size,
                           uint64_t offset, exr_stream_error_func_ptr_t error)
{
    const exr_stream *stream = user;
    uint64_t done = 0;
    while (done < size) {
        const ssize_t n =
            pread(stream->fd, (char *) buffer + done, size - done, (off_t) (offset + done));
        if (n < 0)
            error(ctxt, EXR_ERR_READ_IO, "%s", strerror(errno));
        if (n <= 0)
            return n < 0 ? -1 : (int64_t) done;
        done += (uint64_t) n;
    }
    return (int64_t) done;
}

static int64_t stream_write(exr_const_context_t ctxt, void *user, const void *buffer, uint64_t size,
                            uint64_t offset, exr_stream_error_func_ptr_t error)
{
    const exr_stream *stream = user;
    uint64_t done = 0;
    (void) ctxt;
    (void) error;
    while (done < size) {
        const ssize_t n =
            pwrite(stream->fd, (const char *) buffer + done, size - done, (off_t) (offset + done));
        if (n <= 0) {
            snprintf(stream->why, IMAGE_WHY, "%s", strerror(errno));
            return -1;
        }
        done += (uint64_t) n;
    }
    return (int64_t) done;
}

static exr_context_initializer_t stream_setup(exr_stream *stream, exr_error_handler_cb_t handler)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = handler;
    setup.user_data = stream;
    setup.read_fn = stream_read;
    setup.size_fn = stream_size;
    setup.write_fn = stream_write;
    setup.max_image_width = IMAGE_MAX_SIDE;
    setup.max_image_height = IMAGE_MAX_SIDE;
    setup.flags = EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return setup;
}

static bool ok(exr_result_t result)
{
    return result == EXR_ERR_SUCCESS;
}

// Which of R, G and B a channel is; -1 for all others.
static int channel_index(const char *name)
{
    for (int i = 0; i < 3; ++i)
        if (!strcmp(name, channel_names[i]))
            return i;
    return -1;
}

static bool write_header(exr_context_t exr, const image *img)
{
    int part;
    bool good = ok(exr_add_part(exr, NULL, EXR_STORAGE_SCANLINE, &part)) &&
                ok(exr_initialize_required_attr_simple(exr, part, img->width, img->height,
                                                       EXR_COMPRESSION_ZIP));
    for (int i = 0; good && i < 3; ++i)
        good = ok(exr_add_channel(exr, part, channel_names[i], EXR_PIXEL_FLOAT,
                                  EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
    return good && ok(exr_write_header(exr));
}

static void point_encoder(exr_encode_pipeline_t *pipe, const image *img, int y)
{
    const size_t row = 3 * (size_t) img->width;
    for (int i = 0; i < pipe->channel_count; ++i) {
        exr_coding_channel_info_t *channel = pipe->channels + i;
        const float *from = img->rgb + row * (size_t) y + channel_index(channel->channel_name);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof *from;
        channel->user_pixel_stride = 3 * sizeof *from;
        channel->user_line_stride = (int32_t) (row * sizeof *from);
        channel->encode_from_ptr = (const uint8_t *) from;
    }
}

typedef struct compressor {
    exr_result_t (*compress)(exr_encode_pipeline_t *pipe);
} compressor;

// Readers take a chunk of just its unpacked size for one that is not compressed. OpenEXR 3.1
// writes compressed ones of that very size too; such a chunk is stored as it is here.
static exr_result_t compress_if_smaller(exr_encode_pipeline_t *pipe)
{
    const compressor *usual = pipe->encoding_user_data;
    const exr_result_t result = usual->compress(pipe);
    if (ok(result) && pipe->compressed_bytes == pipe->packed_bytes)
        memcpy(pipe->compressed_buffer, pipe->packed_buffer, pipe->packed_bytes);
    return result;
}

static bool choose_encoder(exr_context_t exr, exr_encode_pipeline_t *pipe, compressor *usual)
{
    if (!ok(exr_encoding_choose_default_routines(exr, 0, pipe)))
        return false;
    usual->compress = pipe->compress_fn;
    pipe->encoding_user_data = usual;
    pipe->compress_fn = compress_if_smaller;
    return usual->compress != NULL;
}

static bool write_chunk(exr_context_t exr, const image *img, int y)
{
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    compressor usual;
    exr_chunk_info_t chunk;
    if (!ok(exr_write_scanline_chunk_info(exr, 0, y, &chunk)) ||
        !ok(exr_encoding_initialize(exr, 0, &chunk, &pipe)))
        return false;
    point_encoder(&pipe, img, y);
    const bool good = choose_encoder(exr, &pipe, &usual) && ok(exr_encoding_run(exr, 0, &pipe));
    exr_encoding_destroy(exr, &pipe);
    return good;
}

static bool write_chunks(exr_context_t exr, const image *img)
{
    int32_t lines;
    bool good = ok(exr_get_scanlines_per_chunk(exr, 0, &lines));
    for (int y = 0; good && y < img->height; y += lines)
        good = write_chunk(exr, img, y);
    return good;
}

static fg_status write_exr(FILE *file, const image *img, image_kind kind, char why[IMAGE_WHY])
{
    (void) kind;
    exr_context_t exr = NULL;
    exr_stream stream = { fileno(file), 0, why };
    const exr_context_initializer_t setup = stream_setup(&stream, stay_silent);
    why[0] = 0;
    bool good = ok(exr_start_write(&exr, "picture", EXR_WRITE_FILE_DIRECTLY, &setup)) &&
                write_header(exr, img) && write_chunks(exr, img);
    if (exr)
        good = ok(exr_finish(&exr)) && good;
    if (good && !why[0])
        return FG_OK;
    if (!why[0])
        snprintf(why, IMAGE_WHY, "the EXR encoder failed");
    return FG_ERR_IO;
}

static bool channels_allowed(exr_const_context_t exr, char why[IMAGE_WHY])
{
    const exr_attr_chlist_t *list;
    int found = 0;
    if (!ok(exr_get_channels(exr, 0, &list)))
        return false;
    for (int i = 0; i < list->num_channels; ++i) {
        const exr_attr_chlist_entry_t *entry = list->entries + i;
        const int index = channel_index(entry->name.str);
        if (index < 0)
            continue;
        found |= 1 << index;
        if (entry->x_sampling != 1 || entry->y_sampling != 1 ||
            (entry->pixel_type != EXR_PIXEL_HALF && entry->pixel_type != EXR_PIXEL_FLOAT)) {
            snprintf(why, IMAGE_WHY, "channel %.20s must be half or float at every pixel",
                     entry->name.str);
            return false;
        }
    }
    if (found != 7)
        snprintf(why, IMAGE_WHY, "must have the channels R, G and B");
    return found == 7;
}

// What the header says: one flat part of scanlines, of a size that is allowed.
static bool layout_allowed(exr_const_context_t exr, exr_attr_box2i_t *box, char why[IMAGE_WHY])
{
    int parts = 0;
    exr_storage_t storage;
    if (!ok(exr_get_count(exr, &parts)) || parts < 1 || !ok(exr_get_storage(exr, 0, &storage)) ||
        !ok(exr_get_data_window(exr, 0, box)))
        return false;
    if (storage != EXR_STORAGE_SCANLINE) {
        snprintf(why, IMAGE_WHY, "tiled and deep EXR pictures are not read");
        return false;
    }
    return image_size_allowed((double) box->max.x - box->min.x + 1,
                              (double) box->max.y - box->min.y + 1, why) &&
           channels_allowed(exr, why);
}

static void point_decoder(exr_decode_pipeline_t *pipe, image *out, int y)
{
    const size_t row = 3 * (size_t) out->width;
    for (int i = 0; i < pipe->channel_count; ++i) {
        exr_coding_channel_info_t *channel = pipe->channels + i;
        const int index = channel_index(channel->channel_name);
        if (index < 0) {
            channel->decode_to_ptr = NULL;
            continue;
        }
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_bytes_per_element = sizeof *out->rgb;
        channel->user_pixel_stride = 3 * sizeof *out->rgb;
        channel->user_line_stride = (int32_t) (row * sizeof *out->rgb);
        channel->decode_to_ptr = (uint8_t *) (out->rgb + row * (size_t) y + index);
    }
}

// The file's own chunk must cover the rows that it was asked for and no more, or the decoder
// would write outside the picture.
static bool chunk_fits(const exr_chunk_info_t *chunk, const image *out, int y, int32_t lines)
{
    return chunk->width == out->width && chunk->height >= 1 && chunk->height <= lines &&
           chunk->height <= out->height - y;
}

static bool read_chunk(exr_const_context_t exr, int32_t first, image *out, int y, int32_t lines)
{
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    if (!ok(exr_read_scanline_chunk_info(exr, 0, first + y, &chunk)) ||
        chunk.start_y != first + y || !chunk_fits(&chunk, out, y, lines) ||
        !ok(exr_decoding_initialize(exr, 0, &chunk, &pipe)))
        return false;
    point_decoder(&pipe, out, y);
    const bool good = ok(exr_decoding_choose_default_routines(exr, 0, &pipe)) &&
                      ok(exr_decoding_run(exr, 0, &pipe));
    exr_decoding_destroy(exr, &pipe);
    return good;
}

static bool read_chunks(exr_const_context_t exr, int32_t first, image *out)
{
    int32_t lines = 0;
    bool good = ok(exr_get_scanlines_per_chunk(exr, 0, &lines)) && lines > 0;
    for (int y = 0; good && y < out->height; y += lines)
        good = read_chunk(exr, first, out, y, lines);
    return good;
}

static fg_status read_exr(FILE *file, int64_t size, image *out, char why[IMAGE_WHY])
{
    exr_context_t exr = NULL;
    exr_attr_box2i_t box;
    exr_stream stream = { fileno(file), size, why };
    const exr_context_initializer_t setup = stream_setup(&stream, on_read_error);
    fg_status status = FG_ERR_INPUT;
    why[0] = 0;
    if (ok(exr_start_read(&exr, "picture", &setup)) && layout_allowed(exr, &box, why)) {
        status = image_alloc(box.max.x - box.min.x + 1, box.max.y - box.min.y + 1, out, why);
        if (status == FG_OK && !read_chunks(exr, box.min.y, out))
            status = FG_ERR_INPUT;
    }
    if (exr)
        exr_finish(&exr);
    if (status != FG_OK && !why[0])
        snprintf(why, IMAGE_WHY, "not an EXR picture, or a broken one");
    return status;
}

const image_coder image_exr = { ".exr", write_exr, read_exr };
