/* files.h -- the files of one run, for common.c: those it reads, and those it writes, which are whole
 * or absent.  What tools call is in common.h. */
#ifndef FILES_H
#define FILES_H

/* Open the null device where standard input, output or error is closed: a file that is opened later
 * must not get its number. */
void files_begin(void);
/* 1 if the data go to a file of -o. */
int files_writing(void);
/* 1 if a write to a file of -o failed. */
int files_failed(void);
/* If text begins with the name of a temporary file: what the user calls that file, and *rest is the
 * text behind the name; else NULL. */
const char *files_name(const char *text, const char **rest);
/* Give what was written its name, or die. */
void files_finish(void);
/* Remove what was written; may be called by a signal handler. */
void files_discard(void);

/* Call handler on the signals that end a tool, once; a signal that nohup ignores stays ignored. */
void catch_signals(void (*handler)(int));

/* In common.c: remove the line that shows progress. */
void clear_progress(void);

#endif
