// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_contact_model_h
#define exemplar_contact_model_h

#include <exemplar/algebra/lbfgs.h>
#include <exemplar/potential/incremental_potential.h>
#include <exemplar/solvers/contact_columns.h>
#include <exemplar/solvers/contact_problem.h>
#include <exemplar/solvers/rotated_metric.h>

#include <memory>
#include <optional>
#include <vector>

namespace Exemplar
{
  /// Directions of quasi-Newton's method where the body touches: they minimise the quadratic model of the body, by its
  /// metric and L-BFGS, which know nothing of contact, plus the exact barriers and friction of gaps that open and close as
  /// their points move. doc/solver.md, "Contact".
  class ContactModel
  {
  public:
    /// All must outlive the object.
    ContactModel(const IncrementalPotential &potential, RotatedMetric &metric, Lbfgs &lbfgs);

    /// Whether there are terms with gaps.
    bool
    is_possible() const
    {
      return potential.gap_width() > 0.;
    }

    /// Gradient of all barriers and friction at these positions, by unknown; empty where no gap of any process pushes.
    std::vector<double>
    gradient(const Vector &positions) const;

    /// A direction on its way: in the frame of the metric.
    struct Direction
    {
      std::vector<double>
          forces; ///< on the body, without contact, with those of the weights' changes
      std::vector<double> step; ///< what they lead to without contact; then the direction
      std::vector<double> weight_changes;
      std::optional<LbfgsCorrection> correction; ///< if it is known
      double greatest_gradient = 0.; ///< entry of the potential's gradient where it begins [N]
    };

    /// Find the step without contact of a body that touches, from its forces, and those on it without the examples' changes.
    void
    find_free_step(const std::vector<double> &of_body, Direction &direction);

    /// L-BFGS has got the pair of the last direction, or not. Its step changed the weights by this much.
    void
    follow(bool has_pair, const std::vector<double> &weight_changes);

    /// Another step begins, or what follows does not go on from the last direction.
    void
    forget_response()
    {
      response = {};
    }

    /// What the weights' quadratic program starts from.
    struct WeightsThere
    {
      const std::vector<double> &gradient;
      const WeightLimits        &limits;
    };

    /// How barriers and friction change along a direction.
    struct AlongDirection
    {
      GapEnergies         gaps;
      std::vector<double> changes; ///< of the rows, by the whole direction [m]

      /// The change by a part of the direction less what the slope at its beginning says [J], of this process: at least 0.
      double
      beyond_slope(double part) const;
    };

    /// Turn a direction without contact into one with it; null, with nothing done, where no gap of any process matters.
    std::unique_ptr<AlongDirection>
    add_contact(const Vector &positions, const WeightsThere &weights, Direction &direction);

    /// Whether the last direction had more rows of gaps than a dense problem may have.
    bool
    has_many_gaps() const
    {
      return many_gaps;
    }

    /// The metric ends here.
    void
    forget()
    {
      columns.clear();
      forget_response();
    }

    /// In bytes.
    std::size_t
    memory_consumption() const
    {
      return columns.memory_consumption();
    }

  private:
    /// A step by degree of freedom, out of the frame of the metric.
    Vector
    displacement(const std::vector<double> &step) const;

    /// Forces of rows by unknown, in the frame of the metric.
    std::vector<double>
    forces_of(const GapEnergies &gaps, const std::vector<double> &by_row) const;

    /// Add what L-BFGS makes of forces to what the metric alone does.
    void
    add_correction(const LbfgsCorrection     &correction,
                   const std::vector<double> &forces,
                   std::vector<double>       &step) const;

    /// H times forces.
    std::vector<double>
    respond(std::vector<double> forces);

    /// A displacement with contact, and the forces of contact that go with it, in the frame of the metric.
    struct Touching
    {
      std::vector<double> step, forces;
    };

    /// With these gaps, and with the weights that follow them, which change `free`. `by_row` are forces of the first rows to begin
    /// with, and then those that have been found.
    Touching
    touch(const GapEnergies     &gaps,
          const WeightsThere    &weights,
          const LbfgsCorrection &correction,
          Direction             &free,
          std::vector<double>   &by_row);

    /// Let the weights follow forces of contact; false if they stay.
    bool
    find_weights(const WeightsThere        &weights,
                 const std::vector<double> &forces_of_contact,
                 const LbfgsCorrection     &correction,
                 Direction                 &free) const;

    /// Whether a dense problem is the way to take.
    bool
    is_dense(const GapEnergies &gaps);

    const IncrementalPotential &potential;
    RotatedMetric              &metric;
    Lbfgs                      &lbfgs;
    ContactColumns              columns;
    bool                        many_gaps = false;

    /// What the metric alone makes of the body's forces without the examples' changes. From one iteration to the next it follows by
    /// what L-BFGS needs of the last pair, too, so that an iteration takes one solve less.
    struct Response
    {
      std::vector<double> of_body;           ///< empty: to be found
      std::vector<double> weight_changes;    ///< of the pair that is not in it yet
      bool                is_behind = false; ///< by that pair
    };

    Response response;
  };
} // namespace Exemplar

#endif
