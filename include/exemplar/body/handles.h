// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_handles_h
#define exemplar_handles_h

#include <exemplar/body/fe_space.h>
#include <exemplar/body/handle.h>
#include <exemplar/body/time_axis.h>
#include <exemplar/mesh/mesh.h>

#include <deal.II/lac/vector.h>

#include <map>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Motions by the names of handles.
  using NamedMotions = std::map<std::string, Motion>;

  /// Nodes with prescribed motions: hard constraints. In quadratic elements a handle also holds the
  /// middle of an edge between two held vertices.
  class Handles
  {
  public:
    /// `poses` contains the poses that handles follow, and `nodes` the files of nodes; handles in
    /// `motions` move as these say of vertices, instead of by their formulas. Throws UserError for
    /// a selection without nodes, an invalid formula, a missing pose, and for handles that overlap
    /// and disagree in any step.
    Handles(const std::vector<HandleParameters> &parameters,
            const Mesh                          &mesh,
            const FESpace                       &fe_space,
            const TimeAxis                      &axis,
            const NamedPoses                    &poses   = {},
            const NamedNodes                    &nodes   = {},
            const NamedMotions                  &motions = {});

    /// Whether a handle also holds the nodes on edges between its vertices, slopes of a shell included,
    /// or the nodes that are given alone.
    enum class Edges
    {
      between_vertices,
      as_given
    };

    /// Add a handle of all components of some nodes of this process, ascending, that `motion`
    /// moves; it replaces a released handle of that name. In quadratic cells the nodes are vertices, and middles of
    /// edges are always held. Throws UserError if a handle of that name
    /// holds nodes. This and the two functions below are collective.
    void
    grab(const std::string               &name,
         const std::vector<unsigned int> &nodes,
         Motion                           motion,
         Edges                            edges = Edges::between_vertices);

    /// Release a handle until hold(). Throws UserError if no handle has this name, or if it has a
    /// From or Until.
    void
    let_go(const std::string &name)
    {
      find_untimed(name).holds = false;
    }

    /// Let a handle hold its nodes again. Throws as let_go().
    void
    hold(const std::string &name)
    {
      find_untimed(name).holds = true;
    }

    /// Whether some handle has a From or Until.
    bool
    have_times() const;

    /// Set which handles with a From or Until hold in a step that begins at time t [s]. Returns
    /// whether this has changed.
    bool
    follow_time(double time);

    /// Begin a step from these positions at this time: nodes that have been caught move on from
    /// there.
    void
    begin_step(double time, const dealii::Vector<double> &positions);

    /// The state of a handle that may change.
    struct Holding
    {
      bool                      holds;
      std::vector<unsigned int> nodes, components;
      Motion                    function;

      std::vector<Handle::FollowingTip> following_tips;
    };

    /// The state of each handle.
    std::vector<Holding>
    holding() const;

    /// Restore the state from holding(); handles added later are removed.
    void
    restore(const std::vector<Holding> &holding);

    /// Held degrees of freedom 3 i + c, ascending and unique.
    std::vector<unsigned int>
    held_dofs() const;

    /// The components in which handles hold the tips of a shell's normals now, by edge; empty without slopes.
    HeldTips
    held_tips() const;

    /// Let `motion` move a handle instead of its formulas. Throws UserError if no handle has this
    /// name.
    void
    set_motion(const std::string &name, Motion motion);

    /// Set the held degrees of freedom to their positions at time t [s]. This and are_elsewhere()
    /// are collective. Throws, with positions half moved, SolverFailure if a motion is not finite;
    /// for motions set by a program, UserError if one does not give one displacement for each
    /// point, or if overlapping handles disagree.
    void
    move(double time, dealii::Vector<double> &positions) const;

    /// Whether move() would change these positions.
    bool
    are_elsewhere(double time, const dealii::Vector<double> &positions) const;

    /// Number of handles.
    unsigned int
    size() const
    {
      return handles.size();
    }

    /// Number of a handle's nodes in the whole body, each counted once.
    unsigned int
    n_nodes(unsigned int handle) const;

    /// Name of a handle in the scene or in grab().
    const std::string &
    name(const unsigned int handle) const
    {
      return handles[handle].name;
    }

    /// Nodes of a handle in this process.
    const std::vector<unsigned int> &
    nodes(const unsigned int handle) const
    {
      return handles[handle].nodes;
    }

    /// Sum of a nodal field over a handle's held degrees of freedom, by component; 0 if it is
    /// released.
    dealii::Tensor<1, 3>
    sum_over(unsigned int handle, const dealii::Vector<double> &field) const;

    /// Warnings to show the user: handles that are crushed as they turn, or turn too far in a step.
    const std::vector<std::string> &
    get_warnings() const
    {
      return warnings;
    }

  private:
    using Displacements = std::vector<std::vector<dealii::Tensor<1, 3>>>;

    /// The handle of this name. Throws UserError if there is none.
    Handle &
    find(const std::string &name);

    /// The handle of this name. Throws UserError if there is none, or if it has a From or Until.
    Handle &
    find_untimed(const std::string &name);

    /// Throws UserError if handles that hold the same degree of freedom disagree in a step of the
    /// axis, or if one of them has caught it.
    void
    check_overlaps(const TimeAxis &axis);

    /// move() where no program has set a motion and no tip follows its edge, by every step, and so without allocation.
    void
    move_by_formulas(double time, dealii::Vector<double> &positions) const;

    /// Set the positions of a handle's nodes; of tips that follow their edges only components that no other handle holds.
    void
    set_positions(const Handle                            &handle,
                  const std::vector<dealii::Tensor<1, 3>> &displacements,
                  const HeldTips                          &tips,
                  dealii::Vector<double>                  &positions) const;

    /// Displacements of all handles at time t [s].
    Displacements
    displacements(double time) const;

    const Mesh              &mesh;
    const FESpace           &fe_space;
    const double             rounding; ///< tolerance of times of steps [s]
    std::vector<Handle>      handles;
    std::vector<std::string> warnings;
  };
} // namespace Exemplar

#endif
