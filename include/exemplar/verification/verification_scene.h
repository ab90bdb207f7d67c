// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_verification_scene_h
#define exemplar_verification_scene_h

#include <exemplar/run/problem/problem.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

// Helpers by which reference cases and unit tests make their problems.

namespace Exemplar::Verification
{
  /// Solve all remaining steps; throws SolverFailure unless each succeeds.
  State
  solve_all_steps(Problem &problem);

  /// A problem from the text of a scene.
  class Scene
  {
  public:
    /// `inputs` stand in for files.
    explicit Scene(const std::string              &text,
                   const std::vector<std::string> &overrides = {},
                   Inputs                          inputs    = {});

    /// See solve_all_steps().
    State
    solve();

    Problem problem;

  private:
    Scene(const CompleteScene &parameters, Inputs inputs);
  };

  /// The generated box with its nodes mapped.
  Inputs
  moved_box(const std::array<double, 3>                                     &size,
            const std::array<unsigned int, 3>                               &n_cells,
            const std::function<dealii::Point<3>(const dealii::Point<3> &)> &map);

  /// "subsection NAME ... end" around lines "set KEY = VALUE", or around other subsections.
  std::string
  section(const std::string &name, const std::string &contents);

  std::string
  set(const std::string &key, const std::string &value);

  std::string
  set(const std::string &key, double value);

  /// The section Mesh of a generated box.
  std::string
  box(const std::array<double, 3> &size, const std::array<unsigned int, 3> &n_cells);

  /// A section of named subsections, Handles or Loads, from (name, contents).
  std::string
  named_sections(const std::string                                      &name,
                 const std::vector<std::pair<std::string, std::string>> &subsections);

  /// Pose function of a bar along x that is twisted by an angle over its length.
  std::string
  twist(double degrees, double length);

  /// Pose function of a bar along x that is bent towards z by an angle.
  std::string
  bend(double degrees, double length);

  /// Rotation by an angle about an axis (Rodrigues).
  Matrix3<double>
  rotation_about(Vector3<double> axis, double angle);

  /// Q x + shift at every node.
  dealii::Vector<double>
  moved_rigidly(const dealii::Vector<double> &positions,
                const Matrix3<double>        &Q,
                const Vector3<double>        &shift);

  Vector3<double>
  node_vector(const dealii::Vector<double> &field, unsigned int node);

  /// Sum of a field over the nodes.
  Vector3<double>
  total(const dealii::Vector<double> &field);

  /// Sum of x cross f over the nodes.
  Vector3<double>
  torque(const dealii::Vector<double> &positions, const dealii::Vector<double> &forces);

  /// M times a nodal field.
  dealii::Vector<double>
  mass_times(const Mass &mass, const dealii::Vector<double> &field);

  double
  max_difference(const dealii::Vector<double> &a, const dealii::Vector<double> &b);

  /// Mean displacement of the nodes in a selection.
  dealii::Tensor<1, 3>
  mean_displacement(const Problem &problem, const State &state, const std::string &selection);

  /// Evaluate at given positions and weights, with the rotations at the positions.
  ElasticEvaluation
  evaluate(Problem                      &problem,
           const dealii::Vector<double> &positions,
           const std::vector<double>    &weights = {});

  /// A quantity on three meshes, each with cells of half the size of the one before.
  struct Refinement
  {
    std::array<double, 3> values;

    /// p of an error C h^p, from the ratio of the two changes.
    double
    order() const;

    /// The limit if the error has even powers of h, as on uniform meshes for smooth solutions:
    /// Romberg's extrapolation, exact for h^2 and h^4.
    double
    smooth_limit() const;

    /// The limit if the error is C h^p with the observed p, as at a singular corner.
    double
    limit() const;
  };
} // namespace Exemplar::Verification

#endif
