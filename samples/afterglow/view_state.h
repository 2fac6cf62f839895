// SPDX-License-Identifier: MIT
#ifndef VIEW_STATE_H
#define VIEW_STATE_H

#include <fg/base.h>

// What the viewer remembers from frame to frame and that needs no window.

// ---- the clock -------------------------------------------------------------------------------

// Time in whole steps of 1/60 s, as render and sequence have it.
typedef struct view_clock {
    int64_t tick;
    double owed; // seconds that have gone by and make no step yet
    bool paused;
    bool stepped; // a step a frame, however long the frame took
} view_clock;

double view_clock_seconds(const view_clock *c);
// `seconds` >= 0 have gone by; of a longer gap a quarter of a second counts.
void view_clock_advance(view_clock *c, double seconds);
void view_clock_step(view_clock *c);  // by one, and stops
void view_clock_reset(view_clock *c); // to 0; goes on or stands as before

// ---- times of frames -------------------------------------------------------------------------

enum { VIEW_HISTORY = 240 };

typedef struct view_history {
    float ms[VIEW_HISTORY];
    int next, count;
} view_history;

void view_history_add(view_history *h, double ms);
double view_history_mean(const view_history *h, int last); // of the last ones; 0: none yet
double view_history_max(const view_history *h);

// ---- messages --------------------------------------------------------------------------------

enum { VIEW_MESSAGES = 6 };

typedef struct view_message {
    fg_log_level level;
    double at; // seconds
    char text[512];
} view_message;

// The newest first.
typedef struct view_messages {
    view_message list[VIEW_MESSAGES];
    int count;
} view_messages;

// One that says what the newest says only makes that new again.
void view_messages_add(view_messages *m, fg_log_level level, double now, const char *text);
// Drops what has been read: errors after a minute, the rest after eight seconds.
void view_messages_age(view_messages *m, double now);

#endif // VIEW_STATE_H
