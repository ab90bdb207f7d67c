// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_example_poses_h
#define exemplar_example_poses_h

#include <exemplar/corotational_consistent.h>
#include <exemplar/expression.h>
#include <exemplar/fe_space.h>
#include <exemplar/material.h>
#include <exemplar/time_axis.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/lac/full_matrix.h>

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  enum class ExampleEnergy
  {
    scaled,
    blended
  };

  enum class ExampleWeights
  {
    simplex,
    free,
    prescribed
  };

  /// Subsection Examples.
  struct ExampleParameters
  {
    std::vector<std::string> poses;
    std::string              pose_functions;
    bool                     include_rest_pose = true;
    double                   importance        = 0.8; ///< eta
    std::string              weight_penalty    = "auto";
    ExampleEnergy            energy            = ExampleEnergy::scaled;
    ExampleWeights           weights           = ExampleWeights::simplex;
    std::string              prescribed_weights;

    void
    declare(dealii::ParameterHandler &prm);

    /// Whether any pose is given and its importance is not 0.
    bool
    in_use() const;

    /// Throws UserError for what no pattern can tell.
    void
    check() const;
  };

  /// The example poses and their strains E_i = S_i - I in every cell, Eq. (4),
  /// computed once. Example 0 is the rest pose where it is included.
  class ExamplePoses
  {
  public:
    /// Reads the pose files. Throws UserError for a pose on another mesh, for
    /// prescribed weights that do not sum to one in every step, and for free
    /// weights without penalty if the examples are affinely dependent.
    ExamplePoses(const ExampleParameters &parameters,
                 const Mesh              &mesh,
                 const FESpace           &fe_space,
                 const Material          &material,
                 const TimeAxis          &axis);

    unsigned int
    size() const
    {
      return positions.size();
    }

    double
    importance() const
    {
      return eta;
    }

    bool
    weights_are_prescribed() const
    {
      return prescribed.has_value();
    }

    /// Prescribed weights at time t.
    std::vector<double>
    prescribed_weights(double time) const;

    /// Node positions of example i, by degree of freedom [m].
    const dealii::Vector<double> &
    pose(const unsigned int i) const
    {
      return positions[i];
    }

    /// E_i in a cell.
    Matrix3<double>
    strain(const unsigned int cell, const unsigned int i) const
    {
      const double *E = entries(cell) + 6 * i;
      return { { { E[0], E[5], E[4] }, { E[5], E[1], E[3] }, { E[4], E[3], E[2] } } };
    }

    /// E(w) = sum_i w_i E_i in a cell.
    Matrix3<double>
    strain(const unsigned int cell, const std::vector<double> &weights) const
    {
      double        sum[6] = { 0., 0., 0., 0., 0., 0. };
      const double *E      = entries(cell);
      for (unsigned int i = first_strained; i < size(); ++i)
        for (unsigned int entry = 0; entry < 6; ++entry)
          sum[entry] += weights[i] * E[6 * i + entry];
      return {
        { { sum[0], sum[5], sum[4] }, { sum[5], sum[1], sum[3] }, { sum[4], sum[3], sum[2] } }
      };
    }

    /// The first example that has strain: the rest pose, where it is included, is
    /// example 0 and has none, so that loops may leave it out.
    unsigned int
    first_strained_example() const
    {
      return first_strained;
    }

    /// (sum V |E_i|^2)^(1/2) over the cells [m^(3/2)].
    double
    strain_norm(const unsigned int i) const
    {
      return strain_norms[i];
    }

    /// Whether weights to find must also not be negative.
    bool
    weights_are_bounded() const
    {
      return bounded;
    }

    /// The second derivative by the weights of what depends on them alone: the ridge
    /// and, with the blended energy, eta (1 - eta) sum V E_i : C : E_j [J].
    const dealii::FullMatrix<double> &
    penalty_matrix() const
    {
      return penalty;
    }

    /// p_0 of Eq. (16): such that the guard leaves every example as it is.
    double
    guard_bound() const
    {
      return p_0;
    }

    /// H_ij = eta^2 sum V E_i : C : E_j and the penalty matrix, Eq. (9) [J].
    const dealii::FullMatrix<double> &
    weight_matrix() const
    {
      return H;
    }

    const std::vector<std::string> &
    get_warnings() const
    {
      return warnings;
    }

  private:
    /// xx, yy, zz, yz, xz, xy of all examples in a cell, one after the other.
    const double *
    entries(const unsigned int cell) const
    {
      return &strains[6 * static_cast<std::size_t>(cell) * size()];
    }

    void
    add_pose(const std::string &name, const std::vector<dealii::Point<3>> &nodes);

    void
    add_pose_functions(const std::string &functions, const Mesh &mesh);

    void
    compute_strains();

    void
    compute_weight_matrix(const Material &material, ExampleEnergy energy);

    void
    check_prescribed_weights(const TimeAxis &axis) const;

    void
    check_independence(const Material &material) const;

    const FESpace                      &fe_space;
    const double                        eta;
    double                              sigma = 0.;
    std::vector<std::string>            names;
    std::vector<dealii::Vector<double>> positions;
    const unsigned int                  first_strained;
    std::vector<double>                 strains;
    std::vector<double>                 strain_norms;
    dealii::FullMatrix<double>          gram; ///< sum V E_i : C : E_j
    dealii::FullMatrix<double>          penalty;
    dealii::FullMatrix<double>          H;
    const bool                          bounded;
    double                              p_0 = default_guard_bound;
    std::optional<Expression>           prescribed;
    std::vector<std::string>            warnings;
  };
} // namespace Exemplar

#endif
