// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_benchmark_unit_h
#define exemplar_benchmark_unit_h

#include <exemplar/base/median.h>
#include <exemplar/run/problem/problem.h>

#include <cstdint>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

// What steps are measured in: durations, the unit of work, and what the machine can do at best.

namespace Exemplar
{
  /// Seconds, by the wall's clock and of this thread's processor time.
  struct Duration
  {
    double wall = 0.;
    double cpu  = 0.;

    Duration
    operator+(const Duration &other) const
    {
      return { wall + other.wall, cpu + other.cpu };
    }
  };

  inline double
  seconds_on(const clockid_t clock)
  {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  template <typename Work>
  Duration
  duration_of(const Work &work)
  {
    const double wall = seconds_on(CLOCK_MONOTONIC), cpu = seconds_on(CLOCK_THREAD_CPUTIME_ID);
    work();
    return { seconds_on(CLOCK_MONOTONIC) - wall, seconds_on(CLOCK_THREAD_CPUTIME_ID) - cpu };
  }

  Duration
  median(const std::vector<Duration> &durations);

  /// Seconds of this thread's processor time of one repetition of `work`, of as many as fill so many seconds.
  template <typename Work>
  double
  seconds_of(const Work &work, const double least_seconds)
  {
    int          n       = 0;
    double       seconds = 0.;
    const double begin   = seconds_on(CLOCK_THREAD_CPUTIME_ID);
    do
    {
      work();
      ++n;
      seconds = seconds_on(CLOCK_THREAD_CPUTIME_ID) - begin;
    } while (seconds < least_seconds);
    return seconds / n;
  }

  /// One factorisation and one solve of a problem's matrix by CHOLMOD.
  class Unit
  {
  public:
    /// At the problem's state; changes nothing there.
    void
    measure(Problem &problem)
    {
      if (!matrix)
      {
        matrix = make_cholmod_operator();
        matrix->reinit(problem.potential.get_tangent().get_pattern());
        measure_once(problem); // touches the factor's memory for the first time
      }
      const Sample sample = measure_once(problem);
      assemble.push_back(sample.assemble);
      factorize.push_back(sample.factorize);
      solve.push_back(sample.solve);
      both.push_back(sample.factorize + sample.solve);
    }

    std::vector<Duration> assemble;
    std::vector<Duration> factorize;
    std::vector<Duration> solve;
    std::vector<Duration> both;

  private:
    struct Sample
    {
      Duration assemble;
      Duration factorize;
      Duration solve;
    };

    Sample
    measure_once(Problem &problem)
    {
      const State &state = problem.state;
      Sample       sample;
      sample.assemble = duration_of(
          [&]
          {
            problem.potential.get_tangent().assemble(state.positions, state.weights, 1.,
                                                     matrix->values(), coupling, &products);
          });
      sample.factorize = duration_of([&] { matrix->factorize(state.positions); });
      column.assign(problem.constraints.free_dofs.size(), 1.);
      sample.solve = duration_of([&] { matrix->solve(column); });
      return sample;
    }

    std::unique_ptr<SpdOperator> matrix;
    std::vector<double>          coupling;
    OuterProducts                products; ///< no part of the matrix where a scene keeps them apart
    std::vector<double>          column;
  };

  /// Operations and bytes of the factor, which the operator does not tell.
  struct FactorSize
  {
    double flops = 0.;
    double bytes = 0.;
  };

  FactorSize
  factor_size(SymmetricPattern pattern);

  /// What the BLAS reaches at best.
  double
  dgemm_gflops();

  /// Read all numbers once; the result depends on each.
  std::uint64_t
  read_all(const std::vector<float> &numbers);

  /// What a core can read and write of the main memory.
  double
  triad_gb_s();

  /// What main() of a benchmark does: `run` on one thread, with the BLAS that programs use; its status, or as the program's if it
  /// throws, with a message.
  int
  run_benchmark(const std::string &name, char *argv[], const std::function<int()> &run);
} // namespace Exemplar

#endif
