// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_handle_h
#define exemplar_handle_h

#include <exemplar/body/handle_nodes.h>
#include <exemplar/body/handle_parameters.h>
#include <exemplar/body/time_axis.h>
#include <exemplar/mesh/rigid_motion.h>
#include <exemplar/prm/expression.h>

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Nodes of this process that move together, and how.
  struct Handle
  {
    std::string               name;
    std::vector<unsigned int> nodes;
    std::vector<unsigned int> components;
    Expression                motion;
    Expression                progress; ///< on the path, if there is one
    std::optional<RigidPath>  path;     ///< of all of the handle to the pose that is followed
    Motion                    function; ///< a program's, instead of all these
    HoldingTime               time  = {};
    bool                      holds = true;

    /// What it holds now: its nodes, or none.
    const std::vector<unsigned int> &
    held_nodes() const
    {
      static const std::vector<unsigned int> none;
      return holds ? nodes : none;
    }

    std::vector<unsigned int> places_in_path = {}; ///< of each node, among those of all processes

    /// How far caught nodes are from where their motion would have them; empty if none are caught.
    std::vector<dealii::Tensor<1, 3>> offsets = {};

    /// Of `nodes`, which are at `rest` at rest, at time t [s], by the motion alone. Throws SolverFailure
    /// if a program's function gives what is not finite, and UserError if it gives not as many as there
    /// are nodes.
    std::vector<dealii::Tensor<1, 3>>
    displacements(const std::vector<dealii::Point<3>> &rest, double time) const;
  };

  /// The handle of a scene. Throws UserError as Handles says. All processes must call this.
  Handle
  make_handle(const HandleParameters &parameters,
              const Mesh             &mesh,
              const FESpace          &fe_space,
              const NamedPoses       &poses,
              const NamedNodes       &nodes);

  /// Of its nodes.
  std::vector<dealii::Point<3>>
  rest_positions(const Handle &handle, const FESpace &fe_space);

  /// What is odd about the ways of handles over the steps of the axis, in sentences with the remedy: some are
  /// crushed as they turn, turn too far in a step, or go far beyond a pose.
  std::vector<std::string>
  review_of_motions(const std::vector<Handle> &handles,
                    const FESpace             &fe_space,
                    const TimeAxis            &axis);

  /// A handle whose time is in no step of the axis, in words; empty if it is in one. Times of steps may be
  /// off by `rounding` [s].
  std::string
  describe_idle_time(const Handle &handle, const TimeAxis &axis, double rounding);
} // namespace Exemplar

#endif
