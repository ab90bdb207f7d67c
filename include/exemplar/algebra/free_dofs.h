// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_free_dofs_h
#define exemplar_free_dofs_h

#include <vector>

namespace Exemplar
{
  /// The degrees of freedom that a solve determines. Degree of freedom 3 i + c is
  /// component c of node i; held ones are no unknowns of the linear system.
  class FreeDofs
  {
  public:
    static constexpr int held = -1;

    FreeDofs(const unsigned int n_dofs, const std::vector<unsigned int> &held_dofs)
        : index(n_dofs, 0)
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

  private:
    std::vector<int>          index;
    std::vector<unsigned int> dofs;
  };
} // namespace Exemplar

#endif
