// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/launcher.h>
#include <exemplar/base/mpi_session.h>
#include <exemplar/base/version.h>
#include <exemplar/program/interrupt.h>
#include <exemplar/program/joint_run.h>

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <iostream>
#include <limits>
#include <mpi.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace Exemplar
{
  namespace
  {
    ProcessGroup together;
    MPI_Comm     ending = MPI_COMM_NULL; ///< for the common end of all joined processes

    /// Time in which other processes may fail as well before all are aborted [s].
    constexpr double time_to_fail = 2.;

    /// Time in which processes that fail alone learn of others that do [s].
    constexpr double time_to_speak = 0.2;

    /// Time for processes to connect [s]. A process of another program would block them forever.
    constexpr unsigned int time_to_join = 120;

    /// Poll a condition every millisecond for `limit` seconds; returns whether it has become true.
    bool
    comes_true(const std::function<bool()> &condition, const double limit)
    {
      using Clock      = std::chrono::steady_clock;
      const auto begin = Clock::now();
      while (!condition())
      {
        if (std::chrono::duration<double>(Clock::now() - begin).count() > limit)
          return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      return true;
    }

    /// Whether all processes call this for `communicator` within `limit` seconds. If not, the
    /// program must end.
    bool
    all_come(MPI_Comm communicator, const double limit)
    {
      MPI_Request request;
      MPI_Ibarrier(communicator, &request);
      return comes_true(
          [&]
          {
            int done = 0;
            MPI_Test(&request, &done, MPI_STATUS_IGNORE);
            return done != 0;
          },
          limit);
    }

    /// The lowest rank with `it_is_me`; the number of processes if there is none.
    unsigned int
    first_of(const bool it_is_me)
    {
      unsigned int first = it_is_me ? together.process : together.n_processes;
      MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_UNSIGNED, MPI_MIN, ending);
      return first;
    }

    /// Whether a process of lower rank fails alone, too; of all that do so within time_to_speak,
    /// exactly one gets false.
    bool
    is_another_before()
    {
      static char              nothing = 0;
      std::vector<MPI_Request> told(together.n_processes - together.process - 1);
      for (unsigned int other = together.process + 1; other < together.n_processes; ++other)
        MPI_Isend(&nothing, 1, MPI_CHAR, other, 0, ending, &told[other - together.process - 1]);
      return comes_true(
          []
          {
            int known = 0;
            MPI_Iprobe(MPI_ANY_SOURCE, 0, ending, &known, MPI_STATUS_IGNORE);
            return known != 0;
          },
          time_to_speak);
    }

    /// The place of a process, to be appended to its message.
    std::string
    place()
    {
      if (together.process == 0)
        return "";
      char name[MPI_MAX_PROCESSOR_NAME];
      int  length = 0;
      MPI_Get_processor_name(name, &length);
      return fmt::format(" (process {} of {}, on {})", together.process, together.n_processes,
                         std::string(name, length));
    }

    /// Wait until the reader of a pipe has taken what stands in it. Open MPI says of MPI_Abort that
    /// output may be lost, depending on when it ends the processes.
    void
    wait_for_reader(const int pipe)
    {
      constexpr double limit = 2.; // [s]; a reader that has stopped must not keep the program
      comes_true(
          [pipe]
          {
            struct stat of_pipe = {};
            int         unread  = 0;
            return fstat(pipe, &of_pipe) != 0 || !S_ISFIFO(of_pipe.st_mode)
                   || ioctl(pipe, FIONREAD, &unread) != 0 || unread == 0;
          },
          limit);
    }

    /// Abort all processes with this status. Unlike after MPI_Finalize, mpirun adds no message of
    /// its own.
    [[noreturn]] void
    end_all(const int status)
    {
      // suppresses Open MPI's message on MPI_Abort
      if (void *quiet = dlsym(RTLD_DEFAULT, "orte_execute_quiet"))
        *static_cast<bool *>(quiet) = true;
      wait_for_reader(STDOUT_FILENO);
      wait_for_reader(STDERR_FILENO);
      MPI_Abort(ending, status);
      _exit(status);
    }

    bool has_joined = false; ///< joined, and not yet in end()

    /// End the single process of mpirun -n 1, which runs without MPI, as end_all() does.
    [[noreturn]] void
    end_alone(const int status)
    {
      std::cout.flush();
      MpiSession::require();
      ending = MPI_COMM_WORLD;
      end_all(status);
    }

    /// atexit handler, for libraries that exit if out of memory: abort the other ranks, which would
    /// hang.
    void
    tell_of_exit()
    {
      if (!has_joined)
        return;
      const char message[] = "exemplar: A library that exemplar uses has ended the program, most "
                             "often for want of memory. Take more machines, or a coarser mesh.\n";
      if (write(STDERR_FILENO, message, sizeof(message) - 1) < 0)
        end_all(2); // no reader; end all the same
      end_all(2);
    }

    [[noreturn]] void
    end_silently(int)
    {
      _exit(130);
    }

    /// SHA-256 of the executable of this process.
    std::string
    digest_of_program()
    {
      try
      {
        return sha256("/proc/self/exe");
      }
      catch (const UserError &) // no /proc, or no permission
      {
        return "";
      }
    }

    /// Exit with an error if processes cannot connect: all but the first silently, and after it, as
    /// the first one's end may kill the others.
    [[noreturn]] void
    refuse_strangers(const Launch &launch, const std::string &reason)
    {
      if (launch.process != 0)
      {
        std::this_thread::sleep_for(std::chrono::seconds(2));
        _exit(1);
      }
      throw UserError(fmt::format("{} has started {} processes that do not find each other: {}",
                                  launch.program, launch.n_processes, reason));
    }

    /// Signal handler for a timeout, where only system calls are safe.
    template <bool speaks>
    [[noreturn]] void
    end_of_waiting(int)
    {
      const char message[] = "exemplar: The processes have not found each other. Start all by one "
                             "command: mpirun -n N exemplar SCENE.prm\n";
      if (speaks && write(STDERR_FILENO, message, sizeof(message) - 1) < 0)
        _exit(1); // no reader; exit all the same
      _exit(1);
    }

    /// Time limit for the processes to connect, which ends with the lifetime of this object.
    class TimeToJoin
    {
    public:
      explicit TimeToJoin(const Launch &launch)
      {
        std::signal(SIGALRM, launch.process == 0 ? end_of_waiting<true> : end_of_waiting<false>);
        alarm(time_to_join + (launch.process == 0 ? 0 : 5)); // the first to end may end all
      }

      TimeToJoin(const TimeToJoin &) = delete;
      TimeToJoin &
      operator=(const TimeToJoin &)
          = delete;

      ~TimeToJoin()
      {
        alarm(0);
        std::signal(SIGALRM, SIG_DFL);
      }
    };

    /// Name of the MPI library in use.
    std::string
    mpi_library()
    {
      char name[MPI_MAX_LIBRARY_VERSION_STRING];
      int  length = 0;
      MPI_Get_library_version(name, &length);
      const std::string text(name, length);
      return text.substr(0, text.find_first_of(",\n"));
    }
  } // namespace

  void
  JointRun::join(const int argc, char *argv[])
  {
    const Launch launch = find_launch();
    if (launch.n_processes == 1)
      return;
    note_interrupts_together(launch.process == 0);
    if (!launch.is_ready_for_mpi)
      refuse_strangers(launch, "it does not prepare them for MPI. Start them by mpirun, or by srun "
                               "--mpi=pmix. If each is to run for itself, unset "
                               "SLURM_STEP_NUM_TASKS before.");
    const TimeToJoin limit(launch);
    MpiSession::require();
    int size = 1, number = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    MPI_Comm_rank(MPI_COMM_WORLD, &number);
    if (launch.n_processes > 1 && size == 1)
      refuse_strangers(launch, "it belongs to another MPI library than exemplar, which uses "
                                   + mpi_library()
                                   + ". Start them by mpirun of that library (Debian: "
                                     "mpirun.openmpi). If each is to run for itself, start it by "
                                     "env -u PMI_SIZE -u PMIX_RANK.");
    if (size == 1)
      return;
    MPI_Comm_dup(MPI_COMM_WORLD, &ending);
    has_joined = true;
    std::atexit(tell_of_exit);
    together = { static_cast<unsigned int>(size), static_cast<unsigned int>(number),
                 [] { all_come(MPI_COMM_WORLD, std::numeric_limits<double>::infinity()); } };

    const std::string program = "exemplar " EXEMPLAR_VERSION " (" EXEMPLAR_GIT_REVISION ")";
    require_same(program + digest_of_program(), "is another program than",
                 "Install the same " + program + " on all machines.");
    std::string arguments;
    for (int i = 1; i < argc; ++i)
      arguments.append(argv[i]).push_back('\0');
    require_same(arguments, "was given other arguments than",
                 fmt::format("Start all by one command: mpirun -n {} exemplar SCENE.prm", size));
  }

  const ProcessGroup &
  JointRun::group()
  {
    return together;
  }

  void
  JointRun::require_same(const std::string &text,
                         const std::string &difference,
                         const std::string &remedy)
  {
    if (together.n_processes == 1)
      return;
    const std::string own = sha256_of_text(text);
    std::string       all(together.n_processes * own.size(), ' ');
    MPI_Allgather(own.data(), own.size(), MPI_CHAR, all.data(), own.size(), MPI_CHAR,
                  MPI_COMM_WORLD);
    for (unsigned int other = 1; other < together.n_processes; ++other)
      if (all.compare(other * own.size(), own.size(), all, 0, own.size()) != 0)
        throw UserError(fmt::format("Process {} of {} {} process 0. {}", other,
                                    together.n_processes, difference, remedy));
  }

  int
  JointRun::end(int status, const std::function<void(const std::string &where)> &report)
  {
    if (together.n_processes == 1)
    {
      report("");
      if (status != 0 && is_child_of_mpirun())
        end_alone(status);
      return status;
    }
    has_joined = false;
    std::cout.flush();
    const bool failed = status != 0;
    if (failed) // others may end this process from now on, silently
      for (const int signal : { SIGINT, SIGTERM, SIGXCPU, SIGHUP, SIGUSR1 })
        std::signal(signal, end_silently);
    if (!all_come(ending, failed ? time_to_fail : std::numeric_limits<double>::infinity()))
    {
      if (is_another_before())
        std::this_thread::sleep_for(std::chrono::seconds(10)); // ended by that one
      else
        report(place());
      end_all(status);
    }
    const unsigned int speaker = first_of(failed);
    if (speaker == together.n_processes)
      return 0;
    if (speaker == together.process)
    {
      report(place());
      wait_for_reader(STDERR_FILENO);
    }
    MPI_Bcast(&status, 1, MPI_INT, speaker, ending); // after the message has been printed
    end_all(status);
  }
} // namespace Exemplar
