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
  /// By the names of handles.
  using NamedMotions = std::map<std::string, Motion>;

  /// Nodes held at places that move in time: hard constraints. Of quadratic elements also those in
  /// the middle of edges between two held nodes of the mesh file.
  class Handles
  {
  public:
    /// The poses that handles follow are among `poses`, the files of nodes among `nodes`; those in
    /// `motions` move as these say of nodes of the mesh file, instead of by their formulas. Throws
    /// UserError for a selection without nodes, a formula that is not understood, a pose that is
    /// not there, and for handles that overlap and disagree in any step.
    Handles(const std::vector<HandleParameters> &parameters,
            const Mesh                          &mesh,
            const FESpace                       &fe_space,
            const TimeAxis                      &axis,
            const NamedPoses                    &poses   = {},
            const NamedNodes                    &nodes   = {},
            const NamedMotions                  &motions = {});

    /// A further handle, of all components of some nodes of this process, ascending, that `motion`
    /// moves; one of that name that was let go becomes this one. Throws UserError if a handle of that name
    /// holds nodes. All processes must call this and the two functions below.
    void
    grab(const std::string &name, const std::vector<unsigned int> &nodes, Motion motion);

    /// From now on a handle holds nothing, until hold(). Throws UserError if no handle has this name, or if
    /// its From and Until say when it holds.
    void
    let_go(const std::string &name)
    {
      find_untimed(name).holds = false;
    }

    /// From now on a handle holds its nodes again. Throws as let_go().
    void
    hold(const std::string &name)
    {
      find_untimed(name).holds = true;
    }

    /// Whether some From or Until says when a handle holds.
    bool
    have_times() const;

    /// Handles with a time hold as they do in a step that begins at time t [s]. Returns whether another
    /// one than before holds.
    bool
    follow_time(double time);

    /// A step begins from these positions at this time: handles that have caught their nodes move them on
    /// from there.
    void
    begin_step(double time, const dealii::Vector<double> &positions);

    /// What may change of a handle.
    struct Holding
    {
      bool                      holds;
      std::vector<unsigned int> nodes, components;
      Motion                    function;
    };

    /// Of each handle.
    std::vector<Holding>
    holding() const;

    /// As when holding() was this: handles that came later are gone.
    void
    restore(const std::vector<Holding> &holding);

    /// Degrees of freedom 3 i + c that are held, ascending, each once.
    std::vector<unsigned int>
    held_dofs() const;

    /// From now on `motion` moves a handle instead of its formulas. Throws UserError if no handle
    /// has this name.
    void
    set_motion(const std::string &name, Motion motion);

    /// Put the held degrees of freedom where they are at time t [s]. All processes that share the body
    /// must call this and are_elsewhere(). Throws SolverFailure if a
    /// motion is not finite and, of motions that a program has set, UserError if one gives not as
    /// many displacements as there are points, or if handles that overlap disagree.
    void
    move(double time, dealii::Vector<double> &positions) const;

    /// Whether move() would change these positions.
    bool
    are_elsewhere(double time, const dealii::Vector<double> &positions) const;

    /// How many handles there are.
    unsigned int
    size() const
    {
      return handles.size();
    }

    /// Of the whole body, each once.
    unsigned int
    n_nodes(unsigned int handle) const;

    /// As the scene or grab() calls it.
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

    /// Sum over a handle's held degrees of freedom of a nodal field, by component; 0 if it is let go.
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

    /// Throws UserError if no handle has this name.
    Handle &
    find(const std::string &name);

    /// The same, and for one with a time.
    Handle &
    find_untimed(const std::string &name);

    /// Throws UserError if handles hold the same and disagree in a step of the axis, or one of them has
    /// caught it.
    void
    check_overlaps(const TimeAxis &axis);

    /// Of all handles at time t [s].
    Displacements
    displacements(double time) const;

    const Mesh              &mesh;
    const FESpace           &fe_space;
    const double             rounding; ///< by which times of steps may be off [s]
    std::vector<Handle>      handles;
    std::vector<std::string> warnings;
  };
} // namespace Exemplar

#endif
