// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/run/scene/scene_file.h>
#include <exemplar/verification/verification_scene.h>

#include <fmt/core.h>

#include <cmath>

namespace Exemplar::Verification
{
  Scene::Scene(const std::string &text, const std::vector<std::string> &overrides, Inputs inputs)
      : Scene(SceneFile("", text, overrides).get_parameters(), std::move(inputs))
  {
  }

  Scene::Scene(const CompleteScene &parameters, Inputs inputs)
      : problem(parameters, read_inputs(parameters, std::move(inputs)))
  {
  }

  State
  solve_all_steps(Problem &problem)
  {
    while (problem.state.step < problem.time_axis.n_steps())
    {
      const SolveReport report = problem.advance();
      if (!is_success(report.status))
        throw SolverFailure(fmt::format("step {}: {}, residual {}", problem.state.step + 1,
                                        status_name(report.status),
                                        shortest_text(report.residual)));
    }
    return problem.state;
  }

  State
  Scene::solve()
  {
    return solve_all_steps(problem);
  }

  Inputs
  moved_box(const std::array<double, 3>                                     &size,
            const std::array<unsigned int, 3>                               &n_cells,
            const std::function<dealii::Point<3>(const dealii::Point<3> &)> &map)
  {
    const SceneFile scene("", set("Scene", "static") + box(size, n_cells),
                          std::vector<std::string>());
    Inputs          inputs{ load_or_make_mesh(scene.get_parameters().mesh), {}, {} };
    for (dealii::Point<3> &node : inputs.mesh.nodes)
      node = map(node);
    return inputs;
  }

  std::string
  section(const std::string &name, const std::string &contents)
  {
    return "subsection " + name + "\n" + contents + "end\n";
  }

  std::string
  set(const std::string &key, const std::string &value)
  {
    return "set " + key + " = " + value + "\n";
  }

  std::string
  set(const std::string &key, const double value)
  {
    return set(key, shortest_text(value));
  }

  std::string
  box(const std::array<double, 3> &size, const std::array<unsigned int, 3> &n_cells)
  {
    std::string sizes, cells;
    for (unsigned int d = 0; d < 3; ++d)
    {
      sizes += (d > 0 ? ", " : "") + shortest_text(size[d]);
      cells += fmt::format("{}{}", d > 0 ? ", " : "", n_cells[d]);
    }
    return section("Mesh",
                   set("Generator", "box") + set("Box size", sizes) + set("Box cells", cells));
  }

  std::string
  named_sections(const std::string                                      &name,
                 const std::vector<std::pair<std::string, std::string>> &subsections)
  {
    std::string names, contents;
    for (const auto &[subsection, text] : subsections)
    {
      names += (names.empty() ? "" : ", ") + subsection;
      contents += section(subsection, text);
    }
    return section(name, set("Names", names) + contents);
  }

  std::string
  twist(const double degrees, const double length)
  {
    const std::string angle = "(" + shortest_text(degrees * M_PI / 180. / length) + "*x)";
    return "x; y*cos" + angle + "-z*sin" + angle + "; y*sin" + angle + "+z*cos" + angle;
  }

  std::string
  bend(const double degrees, const double length)
  {
    const double      curvature = degrees * M_PI / 180. / length;
    const std::string angle     = "(" + shortest_text(curvature) + "*x)",
                      radius    = shortest_text(1. / curvature);
    return "(" + radius + "-z)*sin" + angle + "; y; " + radius + "-(" + radius + "-z)*cos" + angle;
  }

  Matrix3<double>
  rotation_about(Vector3<double> axis, const double angle)
  {
    const double length = std::sqrt(dot(axis, axis));
    for (unsigned int c = 0; c < 3; ++c)
      axis[c] /= length;
    const Matrix3<double> W = skew_matrix(axis), I = identity_matrix<double>();
    return combine(1., combine(1., I, std::sin(angle), W), 1. - std::cos(angle), W * W);
  }

  Vector3<double>
  node_vector(const dealii::Vector<double> &field, const unsigned int node)
  {
    return { { field[3 * node], field[3 * node + 1], field[3 * node + 2] } };
  }

  dealii::Vector<double>
  moved_rigidly(const dealii::Vector<double> &positions,
                const Matrix3<double>        &Q,
                const Vector3<double>        &shift)
  {
    dealii::Vector<double> moved(positions.size());
    for (unsigned int node = 0; node < positions.size() / 3; ++node)
    {
      const Vector3<double> turned = Q * node_vector(positions, node);
      for (unsigned int c = 0; c < 3; ++c)
        moved[3 * node + c] = turned[c] + shift[c];
    }
    return moved;
  }

  Vector3<double>
  total(const dealii::Vector<double> &field)
  {
    Vector3<double> sum{};
    for (unsigned int dof = 0; dof < field.size(); ++dof)
      sum[dof % 3] += field[dof];
    return sum;
  }

  Vector3<double>
  torque(const dealii::Vector<double> &positions, const dealii::Vector<double> &forces)
  {
    Vector3<double> sum{};
    for (unsigned int node = 0; node < positions.size() / 3; ++node)
    {
      const Vector3<double> moment
          = skew_matrix(node_vector(positions, node)) * node_vector(forces, node);
      for (unsigned int c = 0; c < 3; ++c)
        sum[c] += moment[c];
    }
    return sum;
  }

  dealii::Vector<double>
  mass_times(const Mass &mass, const dealii::Vector<double> &field)
  {
    dealii::Vector<double> product(field.size());
    for (auto entry = mass.nodal().begin(); entry != mass.nodal().end(); ++entry)
      for (unsigned int c = 0; c < 3; ++c)
        product[3 * entry->row() + c] += entry->value() * field[3 * entry->column() + c];
    return product;
  }

  double
  max_difference(const dealii::Vector<double> &a, const dealii::Vector<double> &b)
  {
    dealii::Vector<double> difference = a;
    difference -= b;
    return max_entry(difference.begin(), difference.end());
  }

  dealii::Tensor<1, 3>
  mean_displacement(const Problem &problem, const State &state, const std::string &selection)
  {
    dealii::Tensor<1, 3> sum;
    const auto           nodes = Selection{ selection }.nodes(problem.body.mesh, "verify");
    for (const unsigned int node : nodes)
      for (unsigned int c = 0; c < 3; ++c)
        sum[c]
            += state.positions[3 * node + c] - problem.body.fe_space.rest_positions()[3 * node + c];
    return sum / static_cast<double>(nodes.size());
  }

  ElasticEvaluation
  evaluate(Problem                      &problem,
           const dealii::Vector<double> &positions,
           const std::vector<double>    &weights)
  {
    ElasticEvaluation evaluation;
    problem.cells().get_field().update_rotations(positions);
    problem.cells().evaluate(positions, weights, evaluation);
    return evaluation;
  }

  double
  Refinement::order() const
  {
    return std::log2((values[0] - values[1]) / (values[1] - values[2]));
  }

  double
  Refinement::smooth_limit() const
  {
    const double coarse = values[1] + (values[1] - values[0]) / 3.;
    const double fine   = values[2] + (values[2] - values[1]) / 3.;
    return fine + (fine - coarse) / 15.;
  }

  double
  Refinement::limit() const
  {
    const double coarse = values[1] - values[0], fine = values[2] - values[1];
    return values[2] + fine * fine / (coarse - fine);
  }
} // namespace Exemplar::Verification
