// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/blas.h>
#include <exemplar/algebra/cholmod_analysis.h>
#include <exemplar/algebra/multifrontal_factor.h>
#include <exemplar/base/environment.h>
#include <exemplar/base/errors.h>
#include <exemplar/run/scene/scene_file.h>

#include "benchmark_unit.h"

#include <iostream>
#include <nlohmann/json.hpp>

// Measures the kept metric of a scene, a factor in single precision, against what the machine can
// do in the same seconds: its solves against reading the factor twice, its factorisation against a
// matrix product of the BLAS. Usage: benchmark_factor SCENE ['Section/Key=value']... Prints a JSON object.

namespace Exemplar
{
  namespace
  {
    constexpr int    n_rounds           = 9;
    constexpr double seconds_of_a_round = 0.03; ///< for each of what is measured

    template <typename Work>
    double
    seconds_in_round(const Work &work)
    {
      return seconds_of(work, seconds_of_a_round);
    }

    /// A product of matrices in single precision.
    class Product
    {
    public:
      void
      multiply()
      {
        Blas::subtract_product<float>("N", "N", n, n, n, { A.data(), n }, { B.data(), n }, 0.,
                                      { C.data(), n });
      }

      static constexpr int    n            = 1024;
      static constexpr double n_operations = 2. * n * n * n;

    private:
      std::vector<float> A = std::vector<float>(n * n, 1.F), B = A, C = A;
    };

    class Measurement
    {
    public:
      Measurement(const std::string &file, const std::vector<std::string> &overrides)
          : scene(file, overrides),
            problem(scene.get_parameters(), read_inputs(scene.get_parameters()))
      {
        PotentialTangent &tangent = problem.potential.get_tangent();
        tangent.assemble_in_parts(false);
        values.resize(tangent.get_pattern().n_values());
        std::vector<double> columns;
        tangent.assemble(problem.state.positions, problem.state.weights, 1., values, columns);
        CholmodCommon common;
        common.join_more_supernodes();
        cholmod_factor *analysis = analyze(tangent.get_pattern(), common);
        cholmod_bytes            = sizeof(double) * analysis->xsize;
        structure                = std::make_shared<const FactorStructure>(
            factor_structure(tangent.get_pattern(), *analysis, common));
        cholmod_free_factor(&analysis, &common);
      }

      nlohmann::ordered_json
      run()
      {
        MultifrontalFactor<float> factor(structure, 1);
        std::vector<float>        like_factor(structure->n_values(), 1.F);
        Product                   product;
        std::uint64_t             read_sum = 0;
        std::vector<double>       of_factor, of_solve, of_seven, of_reading, of_product;
        std::vector<double>       column(structure->n()), seven(7 * structure->n());
        for (int round = 0; round < n_rounds; ++round)
        {
          of_factor.push_back(seconds_in_round([&] { is_definite = factor.factorize(values); }));
          of_solve.push_back(seconds_in_round(
              [&]
              {
                std::fill(column.begin(), column.end(), 1.);
                factor.solve(column);
              }));
          of_reading.push_back(
              seconds_in_round([&] { read_sum += read_all(like_factor) + read_all(like_factor); }));
          of_seven.push_back(seconds_in_round(
              [&]
              {
                std::fill(seven.begin(), seven.end(), 1.);
                factor.solve(seven);
              }));
          of_product.push_back(seconds_in_round([&] { product.multiply(); }));
        }
        const double gflops      = 1e-9 * structure->n_operations / median(of_factor),
                     gflops_best = 1e-9 * Product::n_operations / median(of_product);
        nlohmann::ordered_json json;
        json["unknowns"]           = structure->n();
        json["supernodes"]         = structure->n_supernodes();
        json["factor_mib"]         = sizeof(float) * structure->n_values() / 1024. / 1024.;
        json["cholmod_mib"]        = cholmod_bytes / 1024. / 1024.;
        json["all_mib"]            = factor.memory_consumption() / 1024. / 1024.;
        json["solve_ms"]           = 1e3 * median(of_solve);
        json["seven_columns_ms"]   = 1e3 * median(of_seven);
        json["read_twice_ms"]      = 1e3 * median(of_reading);
        json["solve_over_reading"] = median(of_solve) / median(of_reading);
        json["factorize_ms"]       = 1e3 * median(of_factor);
        json["gflop_s"]            = gflops;
        json["gflop_s_of_product"] = gflops_best;
        json["share_of_product"]   = gflops / gflops_best;
        json["blas_core"]          = blas_info().core;
        json["definite"]           = is_definite && read_sum > 0;
        return json;
      }

    private:
      SceneFile                              scene;
      Problem                                problem;
      std::vector<double>                    values;
      std::shared_ptr<const FactorStructure> structure;
      double                                 cholmod_bytes = 0.;
      bool                                   is_definite   = false;
    };
  } // namespace
} // namespace Exemplar

int
main(int argc, char *argv[])
{
  return Exemplar::run_benchmark(
      "benchmark_factor", argv,
      [&]
      {
        if (argc < 2)
          throw Exemplar::UserError("usage: benchmark_factor SCENE ['Section/Key=value']...");
        std::cout << Exemplar::Measurement(argv[1], { argv + 2, argv + argc }).run().dump(2)
                  << std::endl;
        return 0;
      });
}
