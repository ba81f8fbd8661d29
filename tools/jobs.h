/* jobs.h -- work on several inputs at a time, each in a process of its own. */
#ifndef JOBS_H
#define JOBS_H

#include <stddef.h>
#include <stdio.h>

/* A job has two files open, and so has one that is done and waits for one before it. */
enum { TOOL_JOBS_MAX = 100 };

/* Call work for each of n inputs with these names, at most at_once at a time, and then done, in order,
 * whichever ends first.
 * work writes its result to a file without a name and may die with a message.  done reads the result from
 * its start; if there is none, result is NULL and why is the last message, or what ended the process. */
typedef void tool_work(size_t i, FILE *result, void *user);
typedef void tool_done(size_t i, FILE *result, const char *why, void *user);
void tool_jobs(char *const input[], size_t n, int at_once, tool_work *work, tool_done *done, void *user);

/* Start work in a process of its own, which signals from the keyboard do not reach, unless the one that was started
 * before is still busy: then the result is 0, or with `wait` comes when that has ended.  If one has failed, this tool
 * ends with its exit status, as its message has been written.  Without work it only waits. */
int tool_start(void (*work)(void *user), void *user, int wait);

#endif
