// SPDX-License-Identifier: MIT
#ifndef FG_GL_PRIV_H
#define FG_GL_PRIV_H

#include <fg/gl.h>

#include <epoxy/gl.h>

// What the parts of the gl device share. Each part owns one struct below and says
// in its functions what it needs; none allocates in a frame equal to the last.

// ---- formats --------------------------------------------------------------------

typedef struct gl_format {
    GLenum internal;
    GLenum pixels, type; // how poison is handed over: the texel's own bits
} gl_format;

const gl_format *gl_format_get(fg_format format);

// The texture target of a resolved descriptor.
GLenum gl_target(const fg_tex_desc *desc);

// ---- framebuffers ---------------------------------------------------------------

enum { GL_MAX_ATTACHMENTS = FG_MAX_WRITES + 1 };

typedef struct gl_framebuffer {
    uint64_t key;
    GLuint name;                        // 0: an empty place
    GLuint objects[GL_MAX_ATTACHMENTS]; // what it holds, to be dropped with them
    int count;
} gl_framebuffer;

typedef struct gl_framebuffers {
    gl_framebuffer *places; // open addressing by key
    int count, capacity;
} gl_framebuffers;

// ---- timers ---------------------------------------------------------------------

// Frames that may be under way before one goes untimed.
enum { GL_TIMER_FRAMES = 6 };

typedef struct gl_timer_frame {
    GLuint *queries; // two for each timer: begin, end
    bool *issued;
    GLuint last; // the query issued last: once it is there all are
    uint64_t frame;
    struct gl_timer_result *results; // of what has come back, until the place is used again
} gl_timer_frame;

typedef struct gl_timer_result {
    uint64_t begin, end; // ns of the device's clock
    uint64_t first;      // when the first pass of the frame began
    uint64_t frame;
    bool valid;
} gl_timer_result;

typedef struct gl_timers {
    bool on_cpu;                       // passes are timed by the clock, see gl_timer.c
    int64_t clock_ahead;               // CLOCK_MONOTONIC minus the device's clock, ns
    uint64_t frame, frame_ns, pass_ns; // then: the frame under way, its start, the pass's
    gl_timer_frame frames[GL_TIMER_FRAMES];
    gl_timer_result *results; // the newest of each timer
    int capacity;             // timers that the arrays hold
    int current;              // frame being recorded; -1: none
    int next;                 // frame to be recorded next
} gl_timers;

// ---- device ---------------------------------------------------------------------

typedef struct gl_programs gl_programs; // program_priv.h

enum { GL_FILTER_COUNT = FG_GL_SHADOW + 1, GL_CLIP_DISTANCES = 8 };

typedef struct gl_device {
    fg_device base; // first: a fg_device * is a gl_device *
    const fg_log *log;
    fg_device_limits limits;
    char renderer[128], version[128];
    int max_label, max_message; // bytes with the final 0

    bool debug;      // driver messages come in
    int errors;      // see fg_gl_error_count()
    int heard;       // errors that came in as messages, since the last glGetError
    bool allocating; // an out of memory error is an answer now
    bool lost;
    GLDEBUGPROC host_callback; // restored by destroy
    void *host_user;
    bool host_synchronous;

    bool software;
    bool in_pass;    // a debug group is open
    bool terminates; // says where frames end, see begin_device()
    GLuint vao;
    GLuint samplers[GL_FILTER_COUNT];
    gl_framebuffers framebuffers;
    gl_timers timers;
    gl_programs *programs;
} gl_device;

// NULL if `dev` is NULL or another kind of device.
gl_device *gl_device_of(fg_device *dev);

// Reads the errors that are there. True if one of them was GL_OUT_OF_MEMORY.
bool gl_drain_errors(gl_device *d);

// Whether GL_RENDERER names one that runs on the CPU.
bool gl_is_software(const char *renderer);

void gl_label(const gl_device *d, GLenum kind, GLuint object, const char *label);

// gl_texture.c
void gl_read_limits(gl_device *d);
fg_status gl_texture_create(fg_device *dev, const char *label, const fg_tex_desc *desc,
                            uint32_t *object);
fg_status gl_view_create(fg_device *dev, const char *label, uint32_t of, const fg_tex_desc *desc,
                         uint32_t *object);
fg_status gl_buffer_create(fg_device *dev, const char *label, uint64_t size, uint32_t *object);
void gl_texture_destroy(fg_device *dev, uint32_t object);
void gl_buffer_destroy(fg_device *dev, uint32_t object);

// gl_clear.c
void gl_clear(fg_device *dev, const fg_clear *clear);

// gl_framebuffer.c
// The framebuffer of these attachments; 0 with a line in the log if GL refuses them.
GLuint gl_framebuffer_get(gl_device *d, const fg_pass_begin *begin);
void gl_framebuffers_drop_object(gl_device *d, GLuint object); // those that hold it
void gl_framebuffers_drop(gl_device *d);                       // all

// gl_timer.c
fg_status gl_timers_begin_frame(gl_device *d, uint64_t frame, int timers);
void gl_timers_end_frame(gl_device *d);
void gl_timers_mark(gl_device *d, int timer, bool end);
void gl_timers_collect(gl_device *d); // takes what has come back; never waits
bool gl_timers_read(fg_device *dev, int timer, double *start_ms, double *ms, uint64_t *frame);
bool gl_timers_of(fg_device *dev, int timer, uint64_t frame, int64_t *begin, int64_t *end);
void gl_timers_set_clock(gl_device *d); // once on_cpu is known
void gl_timers_forget(gl_device *d);
void gl_timers_destroy(gl_device *d);

// program.c
gl_programs *gl_programs_create(const gl_device *d, const fg_gl_device_desc *desc);
void gl_programs_destroy(gl_programs *p); // accepts NULL
uint32_t gl_programs_get(gl_programs *p, const fg_gl_program_desc *desc);

#endif // FG_GL_PRIV_H
