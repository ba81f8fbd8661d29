/*
 * stop_at N SIGNAL LOG COMMAND ...: run the command, and send it the signal as the N-th call begins
 * that writes or that makes, renames or removes a file, by it, its threads or its children.  A line
 * "hit" goes into LOG if it came so far, and with N = 0 the number of such calls.
 * Exits as the command does, with 128 + signal if one ended it, and with 77 where the system does
 * not let a program trace its child.  Linux only.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

/* The calls that are looked at; the rest go on at full speed. */
static const int looked_at[] = {
    SYS_openat, SYS_write, SYS_writev, SYS_pwrite64, SYS_ftruncate, SYS_fsync,
    SYS_linkat, SYS_mkdirat, SYS_renameat, SYS_renameat2, SYS_unlinkat,
#ifdef SYS_rename
    SYS_link, SYS_mkdir, SYS_rename, SYS_rmdir, SYS_unlink,
#endif
};
enum { LOOKED_AT = sizeof looked_at / sizeof *looked_at };

static int
ask_for_stops(void)
{
    struct sock_filter code[2 * LOOKED_AT + 2];
    const struct sock_fprog filter = { .len = sizeof code / sizeof *code, .filter = code };
    struct sock_filter *next = code;

    *next++ = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(struct seccomp_data, nr));
    for (int i = 0; i < LOOKED_AT; i++) {
        *next++ = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (unsigned)looked_at[i], 0, 1);
        *next++ = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRACE);
    }
    *next = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) || prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter);
}

static pid_t
start(char **command)
{
    int go[2];

    if (pipe(go))
        return -1;
    pid_t pid = fork();
    if (pid == 0) {
        char c;
        close(go[1]);
        if (read(go[0], &c, 1) != 0)
            _exit(126);
        close(go[0]);
        if (ask_for_stops())
            _exit(77);
        execvp(command[0], command);
        _exit(127);
    }
    close(go[0]);
    const long options = PTRACE_O_TRACESECCOMP | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK | PTRACE_O_TRACECLONE |
        PTRACE_O_EXITKILL;
    if (pid > 0 && ptrace(PTRACE_SEIZE, pid, 0, options)) {
        kill(pid, SIGKILL);
        pid = -1;
    }
    close(go[1]);               /* the child waits for that */
    return pid;
}

int
main(int argc, char **argv)
{
    if (argc < 5) {
        fprintf(stderr, "usage: stop_at N SIGNAL LOG COMMAND ...\n");
        return 2;
    }
    const long wanted = atol(argv[1]);
    const int sent = atoi(argv[2]);
    const pid_t tool = start(argv + 4);
    if (tool < 0) {
        fprintf(stderr, "stop_at: %s\n", strerror(errno));
        return 77;
    }
    long calls = 0;
    int ended = 0, status;
    /* until the last child of the command ends: what it writes after the command counts too */
    for (pid_t pid; (pid = waitpid(-1, &status, __WALL)) > 0; ) {
        if (!WIFSTOPPED(status)) {
            if (pid == tool)
                ended = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
            continue;
        }
        const int event = status >> 16;
        struct __ptrace_syscall_info call;
        if (event == PTRACE_EVENT_SECCOMP && ptrace(PTRACE_GET_SYSCALL_INFO, pid, sizeof call, &call) > 0 &&
            (call.seccomp.nr != SYS_openat || call.seccomp.args[2] & O_CREAT) && ++calls == wanted)
            kill(tool, sent);
        ptrace(PTRACE_CONT, pid, 0, event != 0 ? 0 : WSTOPSIG(status));
    }
    FILE *log = fopen(argv[3], "a");
    if (log == NULL) {
        perror(argv[3]);
        return 2;
    }
    if (wanted == 0)
        fprintf(log, "%ld\n", calls);
    else if (calls >= wanted)
        fprintf(log, "hit\n");
    return fclose(log) ? 2 : ended;
}
