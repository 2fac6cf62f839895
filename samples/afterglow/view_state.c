// SPDX-License-Identifier: MIT
#include "view_state.h"

#include <stdio.h>
#include <string.h>

// ---- the clock -------------------------------------------------------------------------------

double view_clock_seconds(const view_clock *c)
{
    return (double) c->tick / 60;
}

void view_clock_advance(view_clock *c, double seconds)
{
    if (c->paused)
        return;
    if (c->stepped) {
        ++c->tick;
        return;
    }
    c->owed += seconds < 0.25 ? seconds : 0.25;
    for (; c->owed >= 1.0 / 60; c->owed -= 1.0 / 60)
        ++c->tick;
}

void view_clock_step(view_clock *c)
{
    c->paused = true;
    c->owed = 0;
    ++c->tick;
}

void view_clock_reset(view_clock *c)
{
    c->tick = 0;
    c->owed = 0;
}

// ---- times of frames -------------------------------------------------------------------------

void view_history_add(view_history *h, double ms)
{
    h->ms[h->next] = (float) ms;
    h->next = (h->next + 1) % VIEW_HISTORY;
    h->count += h->count < VIEW_HISTORY;
}

double view_history_mean(const view_history *h, int last)
{
    double sum = 0;
    const int n = last < h->count ? last : h->count;
    for (int i = 1; i <= n; ++i)
        sum += (double) h->ms[(h->next - i + VIEW_HISTORY) % VIEW_HISTORY];
    return n > 0 ? sum / n : 0;
}

double view_history_max(const view_history *h)
{
    float max = 0;
    for (int i = 0; i < h->count; ++i)
        max = h->ms[i] > max ? h->ms[i] : max;
    return (double) max;
}

// ---- messages --------------------------------------------------------------------------------

void view_messages_add(view_messages *m, fg_log_level level, double now, const char *text)
{
    if (!m->count || strncmp(m->list[0].text, text, sizeof m->list[0].text - 1) != 0) {
        memmove(m->list + 1, m->list, (VIEW_MESSAGES - 1) * sizeof *m->list);
        m->count += m->count < VIEW_MESSAGES;
    }
    m->list[0].level = level;
    m->list[0].at = now;
    snprintf(m->list[0].text, sizeof m->list[0].text, "%s", text);
}

void view_messages_age(view_messages *m, double now)
{
    int kept = 0;
    for (int i = 0; i < m->count; ++i) {
        const double life = m->list[i].level == FG_LOG_ERROR ? 60 : 8;
        if (now - m->list[i].at < life)
            m->list[kept++] = m->list[i];
    }
    m->count = kept;
}
