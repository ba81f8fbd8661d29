/* jobs.c -- work on several inputs at a time, so that one that cannot be read ends no other. */
#include "jobs.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "common.h"

enum { LONGEST = 1024 };        /* of a message */

typedef struct job {
    pid_t pid;
    FILE *result, *words;       /* what it writes, and its messages */
    int done, status;
} job;

/* Pass on the messages of a job, and its result.  why becomes the last of the messages, without the tool's name. */
static void
collect(job *j, size_t i, tool_done *done, void *user)
{
    char why[LONGEST] = "";
    rewind(j->words);
    for (int c = 0, first = 1; fgets(why, LONGEST, j->words) != NULL; first = c == '\n') {
        size_t n = strlen(why), name = strcspn(why, " ");
        c = n > 0 ? why[n - 1] : 0;
        fputs(why, stderr);
        why[strcspn(why, "\n")] = '\0';
        if (first && name > 0 && why[name] == ' ' && why[name - 1] == ':' && strncmp(why, "ss-", 3) == 0)
            memmove(why, why + name + 1, strlen(why + name + 1) + 1);
    }
    fclose(j->words);
    if (WIFSIGNALED(j->status))
        snprintf(why, sizeof why, "its process was killed by signal %d", WTERMSIG(j->status));
    rewind(j->result);
    done(i, j->status == 0 ? j->result : NULL, why, user);
    fclose(j->result);
}

void
tool_jobs(char *const input[], size_t n, int at_once, tool_work *work, tool_done *done, void *user)
{
    job *jobs = tool_room(NULL, n, sizeof *jobs);
    size_t begun = 0, ended = 0, most = (size_t)at_once;
    memset(jobs, 0, n * sizeof *jobs);
    for (size_t first = 0; first < n;) {
        for (; begun < n && begun - ended < most && begun - first < 2 * most; begun++) {
            job *j = &jobs[begun];
            j->result = tmpfile();
            j->words = tmpfile();
            if (j->result == NULL || j->words == NULL || (j->pid = fork()) < 0)
                tool_die("%s: no process could be started for it: %s%s", input[begun], strerror(errno),
                         at_once > 1 ? "; a smaller --jobs may do" : "");
            if (j->pid > 0)
                continue;
            dup2(fileno(j->words), STDERR_FILENO);
            work(begun, j->result, user);
            _exit(fflush(j->result) != 0 || ferror(j->result));
        }
        int status;
        pid_t pid = wait(&status);              /* any of those that have begun */
        if (pid < 0)
            tool_die("%s", strerror(errno));
        for (size_t i = first; i < begun; i++)
            if (jobs[i].pid == pid && !jobs[i].done) {
                jobs[i].done = 1;
                jobs[i].status = status;
            }
        for (ended++; first < begun && jobs[first].done; first++)
            collect(&jobs[first], first, done, user);
        tool_progress((double)ended / (double)n, NULL);
    }
    free(jobs);
}

int
tool_start(void (*work)(void *user), void *user, int wait)
{
    static pid_t busy;
    int status = 0;
    pid_t ended = busy > 0 ? waitpid(busy, &status, wait ? 0 : WNOHANG) : busy;
    if (ended == 0 && busy > 0)
        return 0;
    if (status != 0 && !tool_stopping())
        tool_leave(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
    busy = 0;
    if (work == NULL)
        return 1;
    if ((busy = fork()) < 0)
        tool_die("no process could be started: %s", strerror(errno));
    if (busy == 0) {
        setpgid(0, 0);
        work(user);
        tool_end();
        _exit(0);
    }
    return 1;
}
