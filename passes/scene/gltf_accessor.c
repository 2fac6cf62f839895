// SPDX-License-Identifier: MIT
#include "gltf_load.h"

#include <math.h>
#include <string.h>

enum { BYTE = 5120, UBYTE, SHORT, USHORT, UINT = 5125, FLOAT };

size_t gltf_component_size(int type)
{
    switch (type) {
    case BYTE:
    case UBYTE: return 1;
    case SHORT:
    case USHORT: return 2;
    case UINT:
    case FLOAT: return 4;
    default: return 0;
    }
}

static size_t column_stride(const gltf_accessor *a)
{
    size_t packed = gltf_component_size(a->component_type) * (size_t) a->rows;
    return a->columns > 1 ? (packed + 3) & ~(size_t) 3 : packed;
}

size_t gltf_element_size(const gltf_accessor *a)
{
    return column_stride(a) * (size_t) a->columns;
}

size_t gltf_element_extent(const gltf_accessor *a)
{
    return column_stride(a) * (size_t) (a->columns - 1) +
           gltf_component_size(a->component_type) * (size_t) a->rows;
}

static const uint8_t *view_data(const gltf_model *m, int view, size_t offset)
{
    const gltf_view *v = &m->views[view];
    return m->buffers[v->buffer].data + v->offset + offset;
}

gltf_reader gltf_reader_open(const gltf_model *m, int accessor)
{
    const gltf_accessor *a = &m->accessors[accessor];
    gltf_reader r = {
        .count = a->count,
        .stride = gltf_element_size(a),
        .value_stride = gltf_element_size(a),
        .column_stride = column_stride(a),
        .component_type = a->component_type,
        .columns = a->columns,
        .rows = a->rows,
        .normalized = a->normalized,
    };
    if (a->view >= 0) {
        r.data = view_data(m, a->view, a->offset);
        if (m->views[a->view].stride > 0)
            r.stride = m->views[a->view].stride;
    }
    if (a->sparse) {
        r.indices = view_data(m, a->index_view, (size_t) a->index_offset);
        r.values = view_data(m, a->value_view, (size_t) a->value_offset);
        r.sparse_count = (size_t) a->sparse_count;
        r.index_type = a->index_type;
    }
    return r;
}

// Buffers are aligned to nothing, hence the copies.
static uint32_t load_uint(const uint8_t *p, int type)
{
    uint16_t u16;
    uint32_t u32;
    if (type == UBYTE || type == BYTE)
        return *p;
    if (type == USHORT || type == SHORT) {
        memcpy(&u16, p, sizeof u16);
        return u16;
    }
    memcpy(&u32, p, sizeof u32);
    return u32;
}

// glTF 2.0, 3.6.2.2: integers to floats.
static float load_float(const uint8_t *p, int type, bool normalized)
{
    uint32_t bits = load_uint(p, type);
    float value, one;
    switch (type) {
    case BYTE:
        value = (float) (int8_t) bits;
        one = 127;
        break;
    case UBYTE:
        value = (float) bits;
        one = 255;
        break;
    case SHORT:
        value = (float) (int16_t) bits;
        one = 32767;
        break;
    case USHORT:
        value = (float) bits;
        one = 65535;
        break;
    case UINT: return normalized ? (float) (bits / 4294967295.0) : (float) bits;
    default: memcpy(&value, &bits, sizeof value); return value;
    }
    return normalized ? fmaxf(value / one, -1) : value;
}

uint32_t gltf_read_sparse_index(const gltf_reader *r, size_t k)
{
    return load_uint(r->indices + k * gltf_component_size(r->index_type), r->index_type);
}

// Where element `i` is, NULL: zero. Sparse indices increase.
static const uint8_t *element(const gltf_reader *r, size_t i)
{
    size_t low = 0, high = r->sparse_count;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (gltf_read_sparse_index(r, middle) < i)
            low = middle + 1;
        else
            high = middle;
    }
    if (low < r->sparse_count && gltf_read_sparse_index(r, low) == i)
        return r->values + low * r->value_stride;
    return r->data ? r->data + i * r->stride : NULL;
}

void gltf_read_floats(const gltf_reader *r, size_t i, float *out)
{
    const uint8_t *p = element(r, i);
    size_t size = gltf_component_size(r->component_type);
    for (int c = 0; c < r->columns; c++)
        for (int k = 0; k < r->rows; k++)
            *out++ = p ? load_float(p + (size_t) c * r->column_stride + (size_t) k * size,
                                    r->component_type, r->normalized)
                       : 0;
}

uint32_t gltf_read_uint(const gltf_reader *r, size_t i)
{
    const uint8_t *p = element(r, i);
    return p ? load_uint(p, r->component_type) : 0;
}
