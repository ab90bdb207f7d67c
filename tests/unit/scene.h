// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_scene_h
#define exemplar_tests_scene_h

#include <exemplar/problem.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <unistd.h>
#include <vector>

// Whole problems from the text of a scene.
namespace Exemplar::Testing
{
  inline const std::string bar = "subsection Mesh\n set Generator = box\n set Box size = 4, 1, 1\n"
                                 "set Box cells = 4, 1, 1\nend\n";

  inline const std::string held_left = "subsection left\n set Select = boundary 1\nend\n";

  inline const std::string drag = "subsection Handles\n set Names = left, right\n" + held_left
                                  + "subsection right\n set Select = boundary 2\n"
                                    "set Motion = 0.2*t; 0.6*t; 0.3*t\nend\nend\n";

  inline std::string
  examples(const std::string &keys)
  {
    return "subsection Examples\n" + keys + "end\n";
  }

  /// A problem from the text of a scene; nothing is written but a temporary .prm.
  class Scene
  {
  public:
    explicit Scene(const std::string &text, const std::vector<std::string> &overrides = {})
        : file(std::filesystem::temp_directory_path()
               / ("exemplar_test_" + std::to_string(getpid()) + ".prm")),
          parameters((std::ofstream(file) << text << std::flush, file), overrides),
          problem(parameters)
    {
      std::filesystem::remove(file);
    }

    /// All steps; each must succeed.
    State
    solve()
    {
      while (problem.state.step < problem.time_axis.n_steps())
      {
        const SolveReport report = problem.advance();
        if (!is_success(report.status))
          throw std::runtime_error("step " + std::to_string(problem.state.step + 1) + ": "
                                   + status_name(report.status) + ", residual "
                                   + std::to_string(report.residual * 1e9) + "e-9");
      }
      return problem.state;
    }

  private:
    const std::filesystem::path file;
    const Parameters            parameters;

  public:
    Problem problem;
  };

  inline double
  max_difference(const dealii::Vector<double> &a, const dealii::Vector<double> &b)
  {
    dealii::Vector<double> difference = a;
    difference -= b;
    return difference.linfty_norm();
  }
} // namespace Exemplar::Testing

#endif
