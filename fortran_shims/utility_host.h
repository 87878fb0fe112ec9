/* The host's side of the Abaqus utility routines: `lode_utility` provides SINV, SPRINC, SPRIND, ROTSIG, XIT, XPLB_EXIT,
 * STDB_ABQERR, XPLB_ABQERR, GETOUTDIR, GETJOBNAME, GETRANK, GETNUMCPUS, get_thread_id, GETNUMTHREADS, VSPRINC, VSPRIND,
 * MutexInit/Lock/Unlock (and the V... twins) under their Fortran symbol names to the UMATs and VUMATs that a host
 * loads. These functions say what a message and the end of an analysis mean to that host. Set everything up before the
 * first analysis thread starts. */
#ifndef LODE_UTILITY_HOST_H
#define LODE_UTILITY_HOST_H

#ifdef __cplusplus
extern "C" {
#endif

/* Severity is LOP of STDB_ABQERR: 1 information, -1 warning, -2 error, -3 fatal error.
 * The default (NULL) prints to standard error. The handler may be called from several threads at once. */
void lode_utility_on_message(void (*handler)(int severity, const char* text));

/* Called by XIT, XPLB_EXIT and after a message of severity -3. It may leave by an exception or longjmp. If it returns,
 * and by default (NULL), all files are flushed and the process exits with status 4. */
void lode_utility_on_exit(void (*handler)(void));

/* What GETJOBNAME and GETOUTDIR answer; at most 255 characters are kept. Defaults: "lode" and the working directory. */
void lode_utility_set_job_name(const char* name);
void lode_utility_set_output_directory(const char* directory);

/* What GETRANK, GETNUMCPUS (defaults 0 of 1) and GETNUMTHREADS (default 1) answer. */
void lode_utility_set_processes(int rank, int count);
void lode_utility_set_threads(int count);

/* Size in bytes of a real in the Explicit routines (VSPRINC, VSPRIND, XPLB_ABQERR): 8 (default) or, for a
 * single-precision VUMAT, 4. */
void lode_utility_set_explicit_real(int bytes);

#ifdef __cplusplus
}
#endif
#endif
