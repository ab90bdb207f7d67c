// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/mpi_session.h>

#include "benchmark_unit.h"

#include <deal.II/base/exceptions.h>
#include <deal.II/base/multithread_info.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <cholmod.h>
#include <cstring>
#include <iostream>
#include <limits>

namespace Exemplar
{
  Duration
  median(const std::vector<Duration> &durations)
  {
    std::vector<double> wall, cpu;
    for (const Duration &duration : durations)
    {
      wall.push_back(duration.wall);
      cpu.push_back(duration.cpu);
    }
    return { median(wall), median(cpu) };
  }

  FactorSize
  factor_size(SymmetricPattern pattern)
  {
    cholmod_common common{};
    cholmod_start(&common);
    common.supernodal = CHOLMOD_AUTO;
    cholmod_sparse matrix{};
    matrix.nrow = matrix.ncol = pattern.n();
    matrix.nzmax              = pattern.row.size();
    matrix.p                  = pattern.column_start.data();
    matrix.i                  = pattern.row.data();
    matrix.stype              = -1;
    matrix.itype              = CHOLMOD_INT;
    matrix.xtype              = CHOLMOD_PATTERN;
    matrix.dtype              = CHOLMOD_DOUBLE;
    matrix.sorted = matrix.packed = 1;
    cholmod_factor *factor        = cholmod_analyze(&matrix, &common);
    FactorSize      size;
    if (factor != nullptr)
    {
      size.flops = common.fl;
      size.bytes
          = factor->is_super
                ? static_cast<double>(factor->xsize * sizeof(double) + factor->ssize * sizeof(int))
                : common.lnz * (sizeof(double) + sizeof(int));
    }
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
    return size;
  }

  double
  dgemm_gflops()
  {
    constexpr unsigned int           n = 1500;
    dealii::LAPACKFullMatrix<double> A(n), B(n), C(n);
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
      {
        A(i, j) = 1. / (1. + i + j);
        B(i, j) = i < j ? 1. : 0.5;
      }
    double minimum = std::numeric_limits<double>::infinity();
    for (unsigned int repetition = 0; repetition < 4; ++repetition)
      minimum = std::min(minimum, duration_of([&] { A.mmult(C, B); }).cpu);
    return 2e-9 * n * n * n / minimum;
  }

  std::uint64_t
  read_all(const std::vector<float> &numbers)
  {
    asm volatile("" ::: "memory"); // or two readings would be compiled to one
    std::uint64_t sum[8] = {};
    for (std::size_t i = 0; i + 16 <= numbers.size(); i += 16)
      for (int k = 0; k < 8; ++k)
      {
        std::uint64_t pair;
        std::memcpy(&pair, numbers.data() + i + 2 * k, sizeof pair);
        sum[k] += pair;
      }
    return sum[0] + sum[1] + sum[2] + sum[3] + sum[4] + sum[5] + sum[6] + sum[7];
  }

  double
  triad_gb_s()
  {
    const std::size_t         n = 1 << 23; // thrice 64 MiB, more than caches hold
    const std::vector<double> b(n, 1.), c(n, 2.);
    std::vector<double>       a(n, 0.);
    double                    minimum = std::numeric_limits<double>::infinity();
    for (unsigned int repetition = 0; repetition < 5; ++repetition)
      minimum = std::min(minimum, duration_of(
                                      [&]
                                      {
                                        for (std::size_t i = 0; i < n; ++i)
                                          a[i] = b[i] + 0.5 * c[i];
                                      })
                                      .cpu);
    return a[n / 2] > 0. ? 3e-9 * sizeof(double) * n / minimum : 0.;
  }

  int
  run_benchmark(const std::string &name, char *argv[], const std::function<int()> &run)
  {
    restart_with_right_core_type(argv);
    use_one_blas_thread();
    dealii::MultithreadInfo::set_thread_limit(1);
    dealii::deal_II_exceptions::disable_abort_on_exception();
    const MpiSession mpi; // for multigrid
    try
    {
      return run();
    }
    catch (const std::exception &error)
    {
      std::cerr << name << ": " << error.what() << std::endl;
      return dynamic_cast<const UserError *>(&error) != nullptr ? 1 : 2;
    }
  }
} // namespace Exemplar
