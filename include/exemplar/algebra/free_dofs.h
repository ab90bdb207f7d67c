// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_free_dofs_h
#define exemplar_free_dofs_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/algebra/vector.h>

#include <vector>

namespace Exemplar
{
  /// The degrees of freedom of this process that a solve determines. Degree of freedom 3 i + c is
  /// component c of node i; held ones are no unknowns of the linear system.
  class FreeDofs
  {
  public:
    static constexpr int held = -1;

    /// `exchange` must outlive this.
    FreeDofs(const unsigned int               n_dofs,
             const std::vector<unsigned int> &held_dofs,
             const Exchange                  &exchange = Exchange::serial())
        : index(n_dofs, 0), with_others(exchange)
    {
      for (const unsigned int dof : held_dofs)
        index[dof] = held;
      for (unsigned int dof = 0; dof < n_dofs; ++dof)
        if (index[dof] != held)
        {
          index[dof] = static_cast<int>(dofs.size());
          dofs.push_back(dof);
        }
    }

    unsigned int
    size() const
    {
      return dofs.size();
    }

    unsigned int
    n_dofs() const
    {
      return index.size();
    }

    /// With the processes that have the other degrees of freedom of the body.
    const Exchange &
    exchange() const
    {
      return with_others;
    }

    /// Number among the free ones, or `held`.
    int
    free_index(const unsigned int dof) const
    {
      return index[dof];
    }

    /// The free degrees of freedom in ascending order.
    const std::vector<unsigned int> &
    list() const
    {
      return dofs;
    }

    /// The free ones of a field.
    void
    gather(const Vector &field, std::vector<double> &free) const
    {
      free.resize(dofs.size());
      for (std::size_t i = 0; i < dofs.size(); ++i)
        free[i] = field[dofs[i]];
    }

    /// Add a factor times numbers by free degree of freedom to a field.
    void
    add(const double factor, const std::vector<double> &free, Vector &field) const
    {
      for (std::size_t i = 0; i < dofs.size(); ++i)
        field[dofs[i]] += factor * free[i];
    }

  private:
    std::vector<int>          index;
    std::vector<unsigned int> dofs;
    const Exchange           &with_others;
  };
} // namespace Exemplar

#endif
