/* Makes one call of the system or of the allocator fail, or raises a signal there: to be loaded before
 * all else (LD_PRELOAD) into a command, which then runs once for each request instead of once.
 *
 * A request is a line on descriptor 198: KIND N PERSISTENT. KIND is what fails (see kKinds), or the
 * number of a signal; N says at which call, from 1 on, or 0 for never; PERSISTENT is 1 if all calls
 * of the kind from there on fail. "new" is "malloc" without the memory that the command has set aside
 * for such times. For "memory", N is how many KiB there are. The answer on descriptor
 * 199 is a line: the status of the process, and how many calls of each kind there were, or for "memory"
 * how many KiB were in use. FAULT_OUTPUT names the folder for what the command
 * prints (out, err) and, for requests of kind "log", for the order of what it did (log).
 *
 * FAULT='KIND N PERSISTENT' in the environment makes one such run without all that, for debuggers.
 *
 * What runs before main() and after it, in libraries, is left alone, and what they do when they are loaded.
 */
#define _GNU_SOURCE
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

enum { kRequests = 198, kAnswers = 199, kSeconds = 60 };

enum Kind {
  MALLOC, NEW, MEMORY, WRITE, READ, OPEN, RENAME, FSYNC, CLOSE, MMAP, THREAD, SHORT, EINTR_, SIGNAL, LOG, NOTHING
};
static const char *const kKinds[] = {"malloc", "new",    "memory", "write", "read",  "open",   "rename", "fsync",
                                     "close",  "mmap",   "thread", "short", "eintr", "signal", "log",    "nothing"};

static struct {
  enum Kind kind;
  int number; /* of the signal */
  long at;
  int persistent;
  atomic_int armed;
} fault;
static atomic_long *calls; /* of each kind; shared with the server */
static int logging = -1;
static pid_t command; /* gets the signals, also for what its children do */

/* Functions behind ours. */
#define NEXT(name)                                           \
  static __typeof__(&name) next;                             \
  if (next == NULL) *(void **)&next = dlsym(RTLD_NEXT, #name)

/* Tells where the call is that fails, if FAULT_TRACE is in the environment. */
static void trace(void) {
  void *frames[24];
  fault.armed = 0; /* it takes memory itself */
  if (getenv("FAULT_TRACE") != NULL) backtrace_symbols_fd(frames, backtrace(frames, 24), 2);
  fault.armed = 1;
}

/* Whether this call of the kind is the one. */
static int hits(enum Kind kind) {
  if (!fault.armed) return 0;
  const long call = atomic_fetch_add(&calls[kind], 1) + 1;
  if (fault.kind != kind || fault.at == 0 || call < fault.at || (call > fault.at && !fault.persistent)) return 0;
  if (call == fault.at) trace();
  return 1;
}

static int fails(enum Kind kind, int error) {
  if (hits(SIGNAL)) kill(command, fault.number);
  if (!hits(kind)) return 0;
  errno = error;
  return 1;
}

static int interrupted(void) {
  if (!hits(EINTR_)) return 0;
  errno = EINTR;
  return 1;
}

static size_t shortened(size_t size) { return size > 1 && hits(SHORT) ? size / 2 : size; }

static void note(const char *what, const char *name) {
  if (logging < 0 || !fault.armed) return;
  char line[2 * 4096];
  const int length = snprintf(line, sizeof line, "%s %s\n", what, name);
  if (length > 0) syscall(SYS_write, logging, line, (size_t)length);
}
static void note_descriptor(const char *what, int descriptor) {
  if (logging < 0 || !fault.armed) return;
  char link[64];
  char name[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = syscall(SYS_readlink, link, name, sizeof name - 1);
  if (length < 0) return;
  name[length] = 0;
  note(what, name);
}

/* Memory. The names with two underscores are glibc's own. The address sanitizer has its own memory. */
#ifndef SANITIZED
extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);
extern void __libc_free(void *);

static atomic_long in_use; /* bytes, of what main() allocated; calls[MEMORY] is the most in KiB */

/* Whether so many bytes are more than there are. */
static int exceeds(size_t size) {
  if (!fault.armed) return 0;
  const long total = (atomic_load(&in_use) + (long)size) / 1024 + 1;
  if (fault.kind == MEMORY && fault.at > 0 && total > fault.at) return errno = ENOMEM, 1;
  if (total > atomic_load(&calls[MEMORY])) atomic_store(&calls[MEMORY], total);
  return 0;
}
static int lacks(size_t size) {
  const int fails_in_malloc = hits(MALLOC); /* both are counted */
  if (hits(NEW) || fails_in_malloc) return errno = ENOMEM, 1;
  return exceeds(size);
}
static void *taken(void *memory) {
  if (fault.armed && memory != NULL) atomic_fetch_add(&in_use, (long)malloc_usable_size(memory));
  return memory;
}
static void given_back(void *memory) {
  if (fault.armed && memory != NULL) atomic_fetch_sub(&in_use, (long)malloc_usable_size(memory));
}
static void map_more(long size) {
  if (fault.armed) atomic_fetch_add(&in_use, size);
}

void *malloc(size_t size) { return lacks(size) ? NULL : taken(__libc_malloc(size)); }
void *calloc(size_t n, size_t size) { return lacks(n * size) ? NULL : taken(__libc_calloc(n, size)); }
void *realloc(void *old, size_t size) {
  if (lacks(size)) return NULL;
  given_back(old);
  return taken(__libc_realloc(old, size));
}
void free(void *memory) {
  given_back(memory);
  __libc_free(memory);
}
void *memalign(size_t alignment, size_t size) {
  return lacks(size) ? NULL : taken(__libc_memalign(alignment, size));
}
void *aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }
int posix_memalign(void **memory, size_t alignment, size_t size) {
  void *const fresh = memalign(alignment, size);
  if (fresh == NULL) return ENOMEM;
  *memory = fresh;
  return 0;
}
#else
static int exceeds(size_t size) { return (void)size, 0; }
static void map_more(long size) { (void)size; }
#endif

/* std::set_new_handler(): for "new", there is none, so that what fails throws. */
typedef void Handler(void);
Handler *_ZSt15set_new_handlerPFvvE(Handler *handler) {
  Handler *(*next)(Handler *);
  *(void **)&next = dlsym(RTLD_NEXT, "_ZSt15set_new_handlerPFvvE");
  return next(fault.kind == NEW ? NULL : handler);
}

/* Reading and writing. */
ssize_t write(int descriptor, const void *bytes, size_t size) {
  NEXT(write);
  if (fails(WRITE, ENOSPC) || interrupted()) return -1;
  note_descriptor("write", descriptor);
  return next(descriptor, bytes, shortened(size));
}
ssize_t pwrite(int descriptor, const void *bytes, size_t size, off_t position) {
  NEXT(pwrite);
  if (fails(WRITE, ENOSPC) || interrupted()) return -1;
  note_descriptor("write", descriptor);
  return next(descriptor, bytes, shortened(size), position);
}
ssize_t pwrite64(int descriptor, const void *bytes, size_t size, off64_t position) {
  return pwrite(descriptor, bytes, size, position);
}
ssize_t writev(int descriptor, const struct iovec *parts, int count) {
  NEXT(writev);
  if (fails(WRITE, ENOSPC) || interrupted()) return -1;
  note_descriptor("write", descriptor);
  return next(descriptor, parts, count);
}
ssize_t read(int descriptor, void *bytes, size_t size) {
  NEXT(read);
  if (fails(READ, EIO) || interrupted()) return -1;
  return next(descriptor, bytes, shortened(size));
}
ssize_t pread(int descriptor, void *bytes, size_t size, off_t position) {
  NEXT(pread);
  if (fails(READ, EIO) || interrupted()) return -1;
  return next(descriptor, bytes, shortened(size), position);
}
ssize_t pread64(int descriptor, void *bytes, size_t size, off64_t position) {
  return pread(descriptor, bytes, size, position);
}
int ftruncate(int descriptor, off_t size) {
  NEXT(ftruncate);
  if (fails(WRITE, ENOSPC)) return -1;
  note_descriptor("write", descriptor);
  return next(descriptor, size);
}
int ftruncate64(int descriptor, off64_t size) { return ftruncate(descriptor, size); }

/* Names. */
static mode_t mode_of(int flags, va_list rest) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? (mode_t)va_arg(rest, int) : 0;
}
int open(const char *name, int flags, ...) {
  NEXT(open);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  if (fails(OPEN, EMFILE) || interrupted()) return -1;
  return next(name, flags, mode);
}
int open64(const char *name, int flags, ...) {
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  return open(name, flags, mode);
}
int openat(int folder, const char *name, int flags, ...) {
  NEXT(openat);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = mode_of(flags, rest);
  va_end(rest);
  if (fails(OPEN, EMFILE) || interrupted()) return -1;
  return next(folder, name, flags, mode);
}
FILE *fopen(const char *name, const char *mode) {
  NEXT(fopen);
  if (fails(OPEN, EMFILE)) return NULL;
  return next(name, mode);
}
FILE *fopen64(const char *name, const char *mode) { return fopen(name, mode); }
int mkdir(const char *name, mode_t mode) {
  NEXT(mkdir);
  if (fails(OPEN, ENOSPC)) return -1;
  return next(name, mode);
}
DIR *opendir(const char *name) {
  NEXT(opendir);
  if (fails(OPEN, EMFILE)) return NULL;
  return next(name);
}
int rename(const char *from, const char *to) {
  NEXT(rename);
  if (fails(RENAME, EIO)) return -1;
  note("rename", from);
  note("named", to);
  return next(from, to);
}
int renameat2(int folder, const char *from, int other, const char *to, unsigned flags) {
  NEXT(renameat2);
  if (fails(RENAME, EIO)) return -1;
  note("rename", from);
  note("named", to);
  return next(folder, from, other, to, flags);
}
int link(const char *from, const char *to) {
  NEXT(link);
  if (fails(RENAME, EPERM)) return -1;
  return next(from, to);
}
int unlink(const char *name) {
  NEXT(unlink);
  if (hits(SIGNAL)) kill(command, fault.number);
  return next(name);
}

/* What else may fail. */
int fsync(int descriptor) {
  NEXT(fsync);
  if (fails(FSYNC, EIO) || interrupted()) return -1;
  note_descriptor("fsync", descriptor);
  return next(descriptor);
}
int fdatasync(int descriptor) { return fsync(descriptor); }
int close(int descriptor) {
  NEXT(close);
  const int failing = fails(CLOSE, EIO);
  const int closed = next(descriptor); /* it is closed even then */
  if (!failing) return closed;
  errno = EIO;
  return -1;
}
void *mmap(void *where, size_t size, int access, int flags, int descriptor, off_t position) {
  if (fails(MMAP, ENOMEM) || exceeds(size)) return MAP_FAILED;
  void *const mapped = (void *)syscall(SYS_mmap, where, size, access, flags, descriptor, position);
  if (mapped != MAP_FAILED) map_more((long)size);
  return mapped;
}
int munmap(void *where, size_t size) {
  map_more(-(long)size);
  return (int)syscall(SYS_munmap, where, size);
}
void *mmap64(void *where, size_t size, int access, int flags, int descriptor, off64_t position) {
  return mmap(where, size, access, flags, descriptor, position);
}
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*function)(void *),
                   void *argument) {
  NEXT(pthread_create);
  if (hits(THREAD)) return EAGAIN;
  return next(thread, attributes, function, argument);
}

void *dlopen(const char *name, int mode) {
  NEXT(dlopen);
  const int armed = atomic_exchange(&fault.armed, 0);
  void *const library = next(name, mode);
  fault.armed = armed;
  return library;
}

/* The server. */
static int (*main_of_command)(int, char **, char **);

static void reopen(int descriptor, const char *folder, const char *name) {
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  const int fresh = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0666);
  if (fresh < 0 || dup2(fresh, descriptor) < 0) _exit(97);
  close(fresh);
}

static int alone(int argc, char **argv, char **environment) {
  command = getpid();
  fault.armed = 1;
  const int code = main_of_command(argc, argv, environment);
  fault.armed = 0;
  return code;
}

static int run(int argc, char **argv, char **environment) {
  const char *const folder = getenv("FAULT_OUTPUT");
  reopen(1, folder, "out");
  reopen(2, folder, "err");
  if (fault.kind == LOG) {
    logging = 197;
    reopen(logging, folder, "log");
  }
  alarm(kSeconds);
  return alone(argc, argv, environment);
}

static void parse(const char *kind) {
  fault.number = atoi(kind);
  if (fault.number > 0) kind = "signal";
  for (fault.kind = MALLOC; strcmp(kind, kKinds[fault.kind]) != 0; ++fault.kind) {
    if (fault.kind == NOTHING) _exit(98);
  }
}

/* @return  whether it is one */
static int parse_request(const char *line) {
  char kind[16];
  if (sscanf(line, "%15s %ld %d", kind, &fault.at, &fault.persistent) != 3) return 0;
  parse(kind);
  for (int k = 0; k <= NOTHING; ++k) atomic_store(&calls[k], 0);
  return 1;
}

static int serve(int argc, char **argv, char **environment) {
  calls = mmap(NULL, (NOTHING + 1) * sizeof *calls, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (getenv("FAULT") != NULL) {
    return parse_request(getenv("FAULT")) ? alone(argc, argv, environment) : 98;
  }
  FILE *const requests = fdopen(kRequests, "r");
  char line[64];
  while (fgets(line, sizeof line, requests) != NULL && parse_request(line)) {
    const pid_t child = fork();
    if (child == 0) {
      close(kRequests);
      close(kAnswers);
      return run(argc, argv, environment);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    dprintf(kAnswers, "%d", status);
    for (int k = 0; k <= NOTHING; ++k) dprintf(kAnswers, " %s=%ld", kKinds[k], atomic_load(&calls[k]));
    dprintf(kAnswers, "\n");
  }
  _exit(0);
}

int __libc_start_main(int (*command)(int, char **, char **), int argc, char **argv, void (*init)(void),
                      void (*fini)(void), void (*end)(void), void *stack) {
  typedef int Start(int (*)(int, char **, char **), int, char **, void (*)(void), void (*)(void),
                    void (*)(void), void *);
  Start *start;
  *(void **)&start = dlsym(RTLD_NEXT, "__libc_start_main");
  main_of_command = command;
  const int serves = getenv("FAULT") != NULL || fcntl(kRequests, F_GETFD) >= 0;
  if (!serves) return start(command, argc, argv, init, fini, end, stack);
  return start(serve, argc, argv, init, fini, end, stack);
}
