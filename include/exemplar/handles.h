// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_handles_h
#define exemplar_handles_h

#include <exemplar/expression.h>
#include <exemplar/selection.h>
#include <exemplar/time_axis.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/lac/vector.h>

#include <set>
#include <string>
#include <vector>

namespace Exemplar
{
  /// A subsection of Handles.
  struct HandleParameters
  {
    std::string name;
    Selection   select;
    std::string motion     = "0; 0; 0";
    std::string components = "x, y, z";

    void
    declare(dealii::ParameterHandler &prm);
  };

  /// Nodes held at places that move in time: hard constraints.
  class Handles
  {
  public:
    /// Throws UserError for a selection without nodes, a formula that is not
    /// understood, and for handles that overlap and disagree in any step.
    Handles(const std::vector<HandleParameters> &parameters,
            const Mesh                          &mesh,
            const TimeAxis                      &axis);

    /// Degrees of freedom 3 i + c that are held, ascending, each once.
    std::vector<unsigned int>
    held_dofs() const;

    /// Put the held degrees of freedom where they are at time t [s].
    void
    move(double time, dealii::Vector<double> &positions) const;

    unsigned int
    size() const
    {
      return handles.size();
    }

    const std::string &
    name(const unsigned int handle) const
    {
      return handles[handle].name;
    }

    /// Sum over a handle's held degrees of freedom of a nodal field, by component.
    dealii::Tensor<1, 3>
    sum_over(unsigned int handle, const dealii::Vector<double> &field) const;

  private:
    struct Handle
    {
      std::string               name;
      std::vector<unsigned int> nodes;
      std::vector<unsigned int> components;
      Expression                displacement;
    };

    /// Nodes that more than one handle holds.
    std::set<unsigned int>
    shared_nodes() const;

    void
    check_agreement(const std::set<unsigned int> &shared, double time) const;

    const Mesh         &mesh;
    std::vector<Handle> handles;
  };
} // namespace Exemplar

#endif
