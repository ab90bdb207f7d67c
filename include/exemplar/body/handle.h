// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_handle_h
#define exemplar_handle_h

#include <exemplar/body/handle_nodes.h>
#include <exemplar/body/handle_parameters.h>
#include <exemplar/body/time_axis.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/prm/expression.h>

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A handle's nodes in this process, and their prescribed motion.
  struct Handle
  {
    std::string               name;
    std::vector<unsigned int> nodes;
    std::vector<unsigned int> components;
    Expression                motion;
    Expression                progress; ///< fraction of the path, if there is one
    std::optional<RigidPath>  path;     ///< path of the whole handle to the pose followed
    Motion                    function; ///< motion set by a program, instead of the others
    HoldingTime               time  = {};
    bool                      holds = true;

    unsigned int first_slope
        = std::numeric_limits<unsigned int>::max(); ///< NodeNumbering::n_places()

    /// A tip of a normal among `nodes` that follows its edge, and the edge's ends among them.
    struct FollowingTip
    {
      std::size_t point, begin, end;
      TipFrame    frame;
    };

    std::vector<FollowingTip> following_tips
        = {}; ///< those of all slopes, if not all components are held

    /// The components of a node that are prescribed: of slopes all.
    const std::vector<unsigned int> &
    components_of(const unsigned int node) const
    {
      static const std::vector<unsigned int> xyz{ 0, 1, 2 };
      return node < first_slope ? components : xyz;
    }

    /// Those that are held, by bits.
    HeldComponents
    held_components() const
    {
      HeldComponents held = 0;
      for (const unsigned int c : components)
        held |= 1U << c;
      return held;
    }

    /// Nodes that are held now: all of them, or none.
    const std::vector<unsigned int> &
    held_nodes() const
    {
      static const std::vector<unsigned int> none;
      return holds ? nodes : none;
    }

    std::vector<unsigned int> places_in_path = {}; ///< index of each node in the whole handle

    /// Offsets of caught nodes from their prescribed motion; empty if none are caught.
    std::vector<dealii::Tensor<1, 3>> offsets = {};

    /// Prescribed displacement of a node by path or formula, not by a function; of tips that follow their edges that in space.
    dealii::Tensor<1, 3>
    displacement(unsigned int point, const dealii::Point<3> &rest, double time) const;

    /// Prescribed displacements of `nodes`, whose positions at rest are `rest`, at time t [s],
    /// without offsets; of tips that follow their edges those of the slope nodes, see TipFrame. Throws SolverFailure if a program's function is not finite, and UserError
    /// if it does not give one displacement for each node.
    std::vector<dealii::Tensor<1, 3>>
    displacements(const std::vector<dealii::Point<3>> &rest, double time) const;
  };

  /// Make a handle of the scene. Throws UserError as Handles does. Collective.
  Handle
  make_handle(const HandleParameters &parameters,
              const Mesh             &mesh,
              const FESpace          &fe_space,
              const NamedPoses       &poses,
              const NamedNodes       &nodes);

  /// Positions of a handle's nodes at rest [m].
  std::vector<dealii::Point<3>>
  rest_positions(const Handle &handle, const FESpace &fe_space);

  /// Warnings about the motions of handles over the steps of the axis, in sentences with advice:
  /// handles that are crushed as they turn, turn too far in a step, or go far beyond a pose.
  std::vector<std::string>
  review_of_motions(const std::vector<Handle> &handles,
                    const FESpace             &fe_space,
                    const TimeAxis            &axis);

  /// A sentence about a handle that holds in no step of the axis; empty if it holds in one. Times
  /// of steps may be off by `rounding` [s].
  std::string
  describe_idle_time(const Handle &handle, const TimeAxis &axis, double rounding);
} // namespace Exemplar

#endif
