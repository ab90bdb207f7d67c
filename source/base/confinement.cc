// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/confinement.h>
#include <exemplar/base/descriptor.h>

#include <fcntl.h>
#include <linux/landlock.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <memory>

// Two mechanisms of the kernel, each of which suffices where the other is missing. seccomp sees the
// arguments of a system call, but not its file; Landlock sees files.

namespace Exemplar
{
  namespace
  {
    /// System calls that are allowed with any arguments.
    constexpr const char *allowed_calls[] = { // memory
                                        "brk", "madvise", "mmap", "mprotect", "mremap", "munmap",
                                        // open files, and queries of existing ones
                                        "access", "close", "faccessat", "faccessat2", "fstat",
                                        "fstatfs", "getcwd", "getdents64", "lseek", "_llseek",
                                        "lstat", "newfstatat", "fstatat64", "poll", "ppoll",
                                        "pread64", "pwrite64", "read", "readlink", "readlinkat",
                                        "readv", "stat", "statfs", "statx", "write", "writev",
                                        // threads
                                        "futex", "futex_time64", "get_robust_list", "getcpu",
                                        "membarrier", "rseq", "sched_getaffinity", "sched_yield",
                                        "set_robust_list",
                                        // receiving signals, and exit
                                        "exit", "exit_group", "restart_syscall", "rt_sigaction",
                                        "rt_sigpending", "rt_sigprocmask", "rt_sigreturn",
                                        "rt_sigtimedwait", "sigaltstack",
                                        // clocks, numbers and names
                                        "clock_getres", "clock_gettime", "clock_nanosleep",
                                        "getegid", "geteuid", "getgid", "getpid", "getppid",
                                        "getrandom", "getrlimit", "getrusage", "gettid",
                                        "gettimeofday", "getuid", "nanosleep", "sysinfo", "time",
                                        "times", "uname" };

    using Filter = std::unique_ptr<void, void (*)(void *)>;

    /// Allow a call under conditions on its arguments. A call that this machine lacks needs no
    /// rule.
    void
    allow(const Filter &filter, const char *call, const std::vector<scmp_arg_cmp> &arguments = {})
    {
      const int number = seccomp_syscall_resolve_name(call);
      if (number != __NR_SCMP_ERROR)
        seccomp_rule_add_array(filter.get(), SCMP_ACT_ALLOW, number,
                               static_cast<unsigned int>(arguments.size()), arguments.data());
    }

    scmp_arg_cmp
    argument_is(const unsigned int index, const std::uint64_t value)
    {
      return { index, SCMP_CMP_EQ, value, 0 };
    }

    /// Condition on an argument that its masked `bits` equal `value`.
    scmp_arg_cmp
    bits_are(const unsigned int index, const std::uint64_t bits, const std::uint64_t value)
    {
      return { index, SCMP_CMP_MASKED_EQ, bits, value };
    }

    /// Allow system calls that are restricted by their arguments.
    void
    allow_in_part(const Filter &filter)
    {
      const auto     self = static_cast<std::uint64_t>(getpid());
      const auto     none = std::uint64_t(0);
      constexpr auto changes
          = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY);
      allow(filter, "open", { bits_are(1, changes, 0) });
      allow(filter, "openat", { bits_are(2, changes, 0) });
      for (const int command : { F_GETFD, F_SETFD, F_GETFL })
        for (const char *call : { "fcntl", "fcntl64" })
          allow(filter, call, { argument_is(1, static_cast<std::uint64_t>(command)) });
      allow(filter, "ioctl", { argument_is(1, TCGETS) }); // isatty()
      allow(filter, "prlimit64", { argument_is(0, none), argument_is(2, none) });
      allow(filter, "clone", { bits_are(0, CLONE_THREAD, CLONE_THREAD) });
      allow(filter, "tgkill", { argument_is(0, self) }); // abort()
    }

    bool
    restrict_calls()
    {
      const Filter filter(seccomp_init(SCMP_ACT_ERRNO(EPERM)), seccomp_release);
      if (filter == nullptr)
        return false;
      for (const char *call : allowed_calls)
        allow(filter, call);
      allow_in_part(filter);
      // fails as on a kernel without it: libraries then start their threads by clone
      seccomp_rule_add(filter.get(), SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
      return seccomp_load(filter.get()) == 0;
    }

    constexpr std::uint64_t read_file      = LANDLOCK_ACCESS_FS_READ_FILE;
    constexpr std::uint64_t read_directory = LANDLOCK_ACCESS_FS_READ_DIR;

    /// All access rights to files that this version of Landlock can deny: 13 in its first version,
    /// REFER from the second, TRUNCATE from the third.
    std::uint64_t
    landlock_rights(const long version)
    {
      const std::uint64_t first = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;
      return version == 1 ? first : (std::uint64_t(1) << (version == 2 ? 14 : 15)) - 1;
    }

    void
    let_read(const Descriptor &rules, const std::filesystem::path &path)
    {
      const Descriptor file(open(path.c_str(), O_PATH | O_CLOEXEC));
      struct stat      status;
      if (file.number < 0 || fstat(file.number, &status) != 0)
        return; // a missing file cannot be read
      const bool                     is_directory = S_ISDIR(status.st_mode);
      landlock_path_beneath_attr     rule{};
      rule.allowed_access = read_file | (is_directory ? read_directory : 0);
      rule.parent_fd      = file.number;
      syscall(SYS_landlock_add_rule, rules.number, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    }

    bool
    restrict_files(const std::vector<std::filesystem::path> &readable)
    {
      const long version
          = syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
      if (version < 1)
        return false;
      landlock_ruleset_attr handled{};
      handled.handled_access_fs = landlock_rights(version);
      const Descriptor rules(
          syscall(SYS_landlock_create_ruleset, &handled, sizeof(handled), 0));
      if (rules.number < 0)
        return false;
      for (const char *system : { "/usr", "/lib", "/lib64", "/etc", "/proc/self", "/sys/devices/system/cpu" })
        let_read(rules, system);
      for (const std::filesystem::path &path : readable)
        let_read(rules, path);
      return syscall(SYS_landlock_restrict_self, rules.number, 0) == 0;
    }
  } // namespace

  std::vector<std::string>
  confine_this_process(const std::vector<std::filesystem::path> &readable)
  {
    std::vector<std::string> walls;
    const rlimit             no_bytes{ 0, 0 }; // limit of files; pipes have none
    setrlimit(RLIMIT_FSIZE, &no_bytes);
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0)
      return walls;
    const bool has_landlock = restrict_files(readable);
    if (restrict_calls())
      walls.emplace_back("seccomp");
    if (has_landlock)
      walls.emplace_back("landlock");
    return walls;
  }
} // namespace Exemplar
