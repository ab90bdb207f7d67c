// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/mpi_session.h>
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/launcher.h>
#include <exemplar/base/version.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <iostream>
#include <limits>
#include <mpi.h>
#include <mutex>
#include <thread>
#include <unistd.h>
#include <vector>

namespace Exemplar
{
  namespace
  {
    bool         mpi_may_be_started = false, mpi_was_started = false;
    unsigned int n_joined = 1, own_number = 0;
    MPI_Comm     ending = MPI_COMM_NULL; ///< by which those that have joined end together

    /// How long a process that has failed waits for the others to fail, too [s].
    constexpr double time_to_fail = 2.;

    /// How long those that fail alone wait for word of others that do [s].
    constexpr double time_to_speak = 0.2;

    /// How long processes may take to find each other [s]. One that is another program lets them wait
    /// for ever.
    constexpr unsigned int time_to_join = 120;

    /// Look every millisecond whether something is so, for `limit` seconds.
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

    /// Whether all processes call this for `communicator` within `limit` seconds. If not, nothing
    /// but the end of the program can follow.
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

    /// The least of the processes that say `it_is_me`; n_joined if none does.
    unsigned int
    first_of(const bool it_is_me)
    {
      unsigned int first = it_is_me ? own_number : n_joined;
      MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_UNSIGNED, MPI_MIN, ending);
      return first;
    }

    /// Whether a process before this one fails alone, too; all that do so within time_to_speak
    /// find the same one that nobody is before.
    bool
    is_another_before()
    {
      static char              nothing = 0;
      std::vector<MPI_Request> told(n_joined - own_number - 1);
      for (unsigned int other = own_number + 1; other < n_joined; ++other)
        MPI_Isend(&nothing, 1, MPI_CHAR, other, 0, ending, &told[other - own_number - 1]);
      return comes_true(
          []
          {
            int known = 0;
            MPI_Iprobe(MPI_ANY_SOURCE, 0, ending, &known, MPI_STATUS_IGNORE);
            return known != 0;
          },
          time_to_speak);
    }

    /// What follows the message of a process.
    std::string
    place()
    {
      if (own_number == 0)
        return "";
      char name[MPI_MAX_PROCESSOR_NAME];
      int  length = 0;
      MPI_Get_processor_name(name, &length);
      return " (process " + std::to_string(own_number) + " of " + std::to_string(n_joined) + ", on "
             + std::string(name, length) + ")";
    }

    /// End all processes, as if each had returned `status`. Other than after MPI_Finalize, mpirun does
    /// not add to our message eleven lines of its own.
    [[noreturn]] void
    end_all(const int status)
    {
      // what Open MPI would say of MPI_Abort
      if (void *quiet = dlsym(RTLD_DEFAULT, "orte_execute_quiet"))
        *static_cast<bool *>(quiet) = true;
      MPI_Abort(ending, status);
      _exit(status);
    }

    bool has_joined = false; ///< and not yet come to its end

    void
    start_mpi();

    /// As end_all() by the one process of mpirun -n 1, which runs without MPI.
    [[noreturn]] void
    end_alone(const int status)
    {
      std::cout.flush();
      if (!mpi_was_started)
        start_mpi();
      ending = MPI_COMM_WORLD;
      end_all(status);
    }

    /// Libraries end the program where they find no memory. What runs then ends the others, who would wait.
    void
    tell_of_exit()
    {
      if (!has_joined)
        return;
      const char message[] = "exemplar: A library that exemplar uses has ended the program, most "
                             "often for want of memory. Take more machines, or a coarser mesh.\n";
      if (write(STDERR_FILENO, message, sizeof(message) - 1) < 0)
        end_all(2); // nobody listens, which changes nothing
      end_all(2);
    }

    [[noreturn]] void
    end_silently(int)
    {
      _exit(130);
    }

    /// SHA-256 of the program that this process runs.
    std::string
    digest_of_program()
    {
      try
      {
        return sha256("/proc/self/exe");
      }
      catch (const UserError &) // no /proc, or no right to read the file
      {
        return "";
      }
    }

    void
    start_mpi()
    {
      // alone, Open MPI would start a daemon, and look for ssh to do so
      setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
      // hwloc, by which it looks at the machine, would say on stderr what it misses, such as /sys
      setenv("HWLOC_HIDE_ERRORS", "2", 0);
      // who waits for another process lets it have the core: cores may be shared, and the other be late
      setenv("OMPI_MCA_mpi_yield_when_idle", "1", 0);
      // threads with a problem each call MPI one after the other: TrilinosLock
      int provided = 0;
      MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED,
                      &provided); // does not return if it fails
      mpi_was_started = true;
    }

    /// Refuse processes that cannot speak with one voice as they do not find each other: the others than the
    /// first end here, silently, and after it, for one that ends may end all.
    [[noreturn]] void
    refuse_strangers(const Launch &launch, const std::string &reason)
    {
      if (launch.process != 0)
      {
        std::this_thread::sleep_for(std::chrono::seconds(2));
        _exit(1);
      }
      throw UserError(launch.program + " has started " + std::to_string(launch.n_processes)
                      + " processes that do not find each other: " + reason);
    }

    /// A signal handler: nothing but system calls is safe.
    template <bool speaks>
    [[noreturn]] void
    end_of_waiting(int)
    {
      const char message[] = "exemplar: The processes have not found each other. Start all by one "
                             "command: mpirun -n N exemplar SCENE.prm\n";
      if (speaks && write(STDERR_FILENO, message, sizeof(message) - 1) < 0)
        _exit(1); // nobody listens, which changes nothing
      _exit(1);
    }

    /// While it lives, the processes have time_to_join to find each other.
    class TimeToJoin
    {
    public:
      explicit TimeToJoin(const Launch &launch)
      {
        std::signal(SIGALRM, launch.process == 0 ? end_of_waiting<true> : end_of_waiting<false>);
        alarm(time_to_join + (launch.process == 0 ? 0 : 5)); // who ends may end all
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

    /// The MPI library that this program uses, in a few words.
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

  MpiSession::MpiSession()
  {
    mpi_may_be_started = true;
  }

  MpiSession::~MpiSession()
  {
    if (mpi_was_started)
      MPI_Finalize();
    mpi_may_be_started = mpi_was_started = false;
  }

  void
  MpiSession::require()
  {
    static std::mutex                 one_at_a_time; // MPI starts once, whichever thread is first
    const std::lock_guard<std::mutex> lock(one_at_a_time);
    int                               has_started = 0, has_ended = 0;
    MPI_Initialized(&has_started);
    MPI_Finalized(&has_ended);
    if (has_ended != 0)
      throw UserError("Solver/Linear solver = iterative needs MPI, which has ended in this process "
                      "and cannot start again. Call MPI_Finalize, or let the Exemplar::MpiSession "
                      "end, when the last problem is solved.");
    if (has_started != 0)
      return;
    if (!mpi_may_be_started)
      throw UserError("Solver/Linear solver = iterative needs MPI, which this program has not "
                      "started. Call MPI_Init before, or hold an Exemplar::MpiSession in main().");
    start_mpi();
  }

  void
  MpiSession::join(const int argc, char *argv[])
  {
    const Launch launch = find_launch();
    if (launch.is_alone())
      return;
    if (!launch.is_ready_for_mpi)
      refuse_strangers(launch, "it does not prepare them for MPI. Start them by mpirun, or by srun "
                               "--mpi=pmix. If each is to run for itself, unset "
                               "SLURM_STEP_NUM_TASKS before.");
    const TimeToJoin limit(launch);
    require();
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
    n_joined   = static_cast<unsigned int>(size);
    own_number = static_cast<unsigned int>(number);

    const std::string program = "exemplar " EXEMPLAR_VERSION " (" EXEMPLAR_GIT_REVISION ")";
    require_same(program + digest_of_program(), "is another program than",
                 "Install the same " + program + " on all machines.");
    std::string arguments;
    for (int i = 1; i < argc; ++i)
      arguments.append(argv[i]).push_back('\0');
    require_same(arguments, "was given other arguments than",
                 "Start all by one command: mpirun -n " + std::to_string(size)
                     + " exemplar SCENE.prm");
  }

  unsigned int
  MpiSession::n_processes()
  {
    return n_joined;
  }

  unsigned int
  MpiSession::process()
  {
    return own_number;
  }

  void
  MpiSession::require_same(const std::string &text,
                           const std::string &difference,
                           const std::string &remedy)
  {
    if (n_joined == 1)
      return;
    const std::string own = sha256_of_text(text);
    std::string       all(n_joined * own.size(), ' ');
    MPI_Allgather(own.data(), own.size(), MPI_CHAR, all.data(), own.size(), MPI_CHAR,
                  MPI_COMM_WORLD);
    for (unsigned int other = 1; other < n_joined; ++other)
      if (all.compare(other * own.size(), own.size(), all, 0, own.size()) != 0)
        throw UserError("Process " + std::to_string(other) + " of " + std::to_string(n_joined) + ' '
                        + difference + " process 0. " + remedy);
  }

  void
  MpiSession::wait_for_all()
  {
    if (n_joined > 1)
      all_come(MPI_COMM_WORLD, std::numeric_limits<double>::infinity());
  }

  int
  MpiSession::end(int status, const std::function<void(const std::string &where)> &report)
  {
    if (n_joined == 1)
    {
      report("");
      if (status != 0 && is_child_of_mpirun())
        end_alone(status);
      return status;
    }
    has_joined = false;
    std::cout.flush();
    const bool failed = status != 0;
    if (failed) // the others may end this process any time now, and it has nothing to say of that
      for (const int signal : { SIGINT, SIGTERM, SIGXCPU, SIGHUP, SIGUSR1 })
        std::signal(signal, end_silently);
    if (!all_come(ending, failed ? time_to_fail : std::numeric_limits<double>::infinity()))
    {
      if (is_another_before())
        std::this_thread::sleep_for(std::chrono::seconds(10)); // that one ends this one
      else
        report(place());
      end_all(status);
    }
    const unsigned int speaker = first_of(failed);
    if (speaker == n_joined)
      return 0;
    if (speaker == own_number)
      report(place());
    MPI_Bcast(&status, 1, MPI_INT, speaker, ending); // also: the message is out
    end_all(status);
  }
} // namespace Exemplar
