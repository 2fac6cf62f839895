// SPDX-License-Identifier: MIT
#include "manage_priv.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A message of the other thread, until the next frame: the log is the caller's.
typedef struct message {
    fg_log_level level;
    char text[256];
} message;

enum { MAX_MESSAGES = 4 };

// `busy` says whose all but the lock's own fields are: the thread's while it is true.
struct iir_worker {
    const fg_log *log;
    fg_log kept;
    message messages[MAX_MESSAGES];
    int message_count;
    iir_manager *manager;
    ag_light *lights; // copies
    int light_capacity;
    iir_lights job;
    iir_budget budget;
    const iir_result *result;
    fg_status status;
    bool pending; // a job has been started whose result nobody has seen
    bool has_lock, has_signal, has_thread;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t signal;
    bool busy, quit;
};

static void keep_message(void *user, fg_log_level level, const char *text)
{
    iir_worker *w = user;
    if (w->message_count == MAX_MESSAGES)
        return;
    message *to = &w->messages[w->message_count++];
    to->level = level;
    snprintf(to->text, sizeof to->text, "%s", text);
}

static void pass_on(iir_worker *w)
{
    for (int i = 0; i < w->message_count; i++)
        fg_logf(w->log, w->messages[i].level, "%s", w->messages[i].text);
    w->message_count = 0;
}

// ---- the thread -------------------------------------------------------------------------------

static void *work(void *user)
{
    iir_worker *w = user;
    pthread_mutex_lock(&w->lock);
    while (!w->quit) {
        if (!w->busy) {
            pthread_cond_wait(&w->signal, &w->lock);
            continue;
        }
        pthread_mutex_unlock(&w->lock);
        w->status = iir_manager_step(w->manager, &w->job, &w->budget, &w->result);
        pthread_mutex_lock(&w->lock);
        w->busy = false;
        pthread_cond_signal(&w->signal);
    }
    pthread_mutex_unlock(&w->lock);
    return NULL;
}

static void start(iir_worker *w)
{
    pthread_mutex_lock(&w->lock);
    w->busy = true;
    pthread_cond_signal(&w->signal);
    pthread_mutex_unlock(&w->lock);
    w->pending = true;
}

static void wait_for_job(iir_worker *w)
{
    pthread_mutex_lock(&w->lock);
    while (w->busy)
        pthread_cond_wait(&w->signal, &w->lock);
    pthread_mutex_unlock(&w->lock);
}

// ---- making -----------------------------------------------------------------------------------

static fg_status begin(iir_worker *w, const iir_manager_desc *desc)
{
    iir_manager_desc own = *desc;
    w->kept = (fg_log){ .fn = keep_message, .user = w, .level = desc->log ? desc->log->level : 0 };
    own.log = &w->kept;
    const fg_status status = iir_manager_create(&own, &w->manager);
    if (status != FG_OK)
        return status;
    w->has_lock = pthread_mutex_init(&w->lock, NULL) == 0;
    w->has_signal = pthread_cond_init(&w->signal, NULL) == 0;
    w->has_thread = w->has_lock && w->has_signal && pthread_create(&w->thread, NULL, work, w) == 0;
    if (!w->has_thread)
        fg_logf(desc->log, FG_LOG_ERROR, "iir: the system has no thread for the VPLs");
    return w->has_thread ? FG_OK : FG_ERR_MEMORY;
}

fg_status iir_worker_create(const iir_manager_desc *desc, iir_worker **out)
{
    *out = NULL;
    iir_worker *w = calloc(1, sizeof *w);
    if (!w) {
        fg_logf(desc->log, FG_LOG_ERROR, "iir: out of memory");
        return FG_ERR_MEMORY;
    }
    w->log = desc->log;
    const fg_status status = begin(w, desc);
    pass_on(w);
    if (status != FG_OK) {
        iir_worker_destroy(w);
        return status;
    }
    *out = w;
    return FG_OK;
}

void iir_worker_destroy(iir_worker *w)
{
    if (!w)
        return;
    if (w->has_thread) {
        pthread_mutex_lock(&w->lock);
        w->quit = true;
        pthread_cond_signal(&w->signal);
        pthread_mutex_unlock(&w->lock);
        pthread_join(w->thread, NULL);
    }
    if (w->has_signal)
        pthread_cond_destroy(&w->signal);
    if (w->has_lock)
        pthread_mutex_destroy(&w->lock);
    iir_manager_destroy(w->manager);
    free(w->lights);
    free(w);
}

// ---- frames -----------------------------------------------------------------------------------

static fg_status take_job(iir_worker *w, const iir_lights *lights, const iir_budget *budget)
{
    if (lights->count > w->light_capacity) {
        ag_light *larger = realloc(w->lights, (size_t) lights->count * sizeof *larger);
        if (!larger) {
            fg_logf(w->log, FG_LOG_ERROR, "iir: out of memory for %d lights", lights->count);
            return FG_ERR_MEMORY;
        }
        w->lights = larger;
        w->light_capacity = lights->count;
    }
    w->job = *lights;
    w->job.lights = w->lights;
    if (lights->count > 0)
        memcpy(w->lights, lights->lights, (size_t) lights->count * sizeof *w->lights);
    w->budget = *budget;
    return FG_OK;
}

fg_status iir_worker_frame(iir_worker *w, const iir_lights *lights, const iir_budget *budget,
                           int delay, const iir_result **out)
{
    *out = NULL;
    wait_for_job(w);
    const bool ready = w->pending;
    const iir_result *result = w->result;
    fg_status status = ready ? w->status : FG_OK;
    w->pending = false;
    if (status == FG_OK)
        status = take_job(w, lights, budget);
    // What a job has made that nobody gets to see has no shadow maps yet.
    if (ready && (delay == 0 || status != FG_OK))
        iir_manager_unseen(w->manager);
    if (status == FG_OK && (!ready || delay == 0))
        status = iir_manager_step(w->manager, &w->job, &w->budget, &result);
    pass_on(w);
    if (status != FG_OK)
        return status;
    if (delay > 0)
        start(w);
    *out = result;
    return FG_OK;
}
