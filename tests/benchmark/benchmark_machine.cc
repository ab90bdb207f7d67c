// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/blas.h>
#include <exemplar/base/environment.h>

#include "benchmark_unit.h"

#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>

// What one core can do at best: products of matrices, and reading from each level of its memory. Prints a JSON object.

namespace Exemplar
{
  namespace
  {
    constexpr int    n_rounds           = 15;
    constexpr double seconds_of_a_round = 0.05;

    /// Least seconds of one repetition of `work` over all rounds.
    template <typename Work>
    double
    least_seconds_of(const Work &work)
    {
      double least = std::numeric_limits<double>::infinity();
      for (int round = 0; round < n_rounds; ++round)
        least = std::min(least, seconds_of(work, seconds_of_a_round));
      return least;
    }

    /// GFLOP/s of a product of matrices.
    template <typename Number>
    double
    product_gflops()
    {
      constexpr int             n = 1024;
      const std::vector<Number> A(n * n, Number(1)), B(A);
      std::vector<Number>       C(A);
      return 2e-9 * n * n * n
             / least_seconds_of(
                 [&]
                 {
                   Blas::subtract_product<Number>("N", "N", n, n, n, { A.data(), n },
                                                  { B.data(), n }, 0., { C.data(), n });
                 });
    }

    /// GB/s of reading so many bytes again and again.
    double
    reading_gb_s(const std::size_t bytes)
    {
      const std::vector<float> numbers(bytes / sizeof(float), 1.F);
      const std::size_t        n_passes
          = std::max<std::size_t>(1, (std::size_t(1) << 23) / bytes); // clocks cost time, too
      std::uint64_t all     = 0;
      const double  seconds = least_seconds_of(
          [&]
          {
            for (std::size_t pass = 0; pass < n_passes; ++pass)
              all += read_all(numbers);
          });
      return all > 0 ? 1e-9 * static_cast<double>(n_passes * bytes) / seconds : 0.;
    }

    nlohmann::ordered_json
    measure()
    {
      constexpr std::size_t  kib = 1024, mib = 1024 * kib;
      nlohmann::ordered_json json;
      json["blas_core"]      = blas_info().core;
      json["gflop_s_single"] = product_gflops<float>();
      json["gflop_s_double"] = product_gflops<double>();
      json["gb_s_16_kib"]    = reading_gb_s(16 * kib);
      json["gb_s_256_kib"]   = reading_gb_s(256 * kib);
      json["gb_s_4_mib"]     = reading_gb_s(4 * mib);
      json["gb_s_512_mib"]   = reading_gb_s(512 * mib);
      json["gb_s_triad"]     = triad_gb_s();
      return json;
    }
  } // namespace
} // namespace Exemplar

int
main(int /*argc*/, char *argv[])
{
  return Exemplar::run_benchmark("benchmark_machine", argv,
                                 []
                                 {
                                   std::cout << Exemplar::measure().dump(2) << std::endl;
                                   return 0;
                                 });
}
