// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_free_dofs_h
#define exemplar_free_dofs_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/algebra/vector.h>

#include <vector>

namespace Exemplar
{
  /// The degrees of freedom that a solve determines. Degree of freedom 3 i + c is component c of
  /// node i; held ones are eliminated from the linear system. Each process assembles for all free
  /// ones at its nodes, and each is an unknown of exactly one process. Held ones may change between
  /// steps.
  class FreeDofs
  {
  public:
    static constexpr int held = -1;

    /// `exchange` must outlive this.
    FreeDofs(const unsigned int               n_dofs,
             const std::vector<unsigned int> &held_dofs,
             const Exchange                  &exchange)
        : index(n_dofs), own_index(n_dofs), with_others(exchange)
    {
      reinit(held_dofs);
    }

    /// Replace the held degrees of freedom. Collective.
    void
    reinit(const std::vector<unsigned int> &held_dofs);

    /// Number of calls of reinit(), by which dependent data notice that they are outdated.
    unsigned int
    version() const
    {
      return n_reinits;
    }

    /// Number of unknowns of this process.
    unsigned int
    size() const
    {
      return list().size();
    }

    unsigned int
    n_dofs() const
    {
      return index.size();
    }

    /// The exchange with the processes that have the other degrees of freedom of the body.
    const Exchange &
    exchange() const
    {
      return with_others;
    }

    /// The unknowns of this process in ascending order: the free degrees of freedom of its nodes
    /// without those that other processes own.
    const std::vector<unsigned int> &
    list() const
    {
      return own_dofs;
    }

    /// Index in list(), or `held` for a degree of freedom that is no unknown of this process.
    int
    unknown_index(const unsigned int dof) const
    {
      return own_index[dof];
    }

    /// All free degrees of freedom of this process' nodes, which the matrices of its cells couple,
    /// in ascending order.
    const std::vector<unsigned int> &
    local_list() const
    {
      return dofs;
    }

    /// Index in local_list(), or `held`.
    int
    free_index(const unsigned int dof) const
    {
      return index[dof];
    }

    /// The greatest magnitude of a field at the unknowns of all processes. Collective.
    double
    max_magnitude(const Vector &field) const;

    /// Copy the entries of a field at the unknowns.
    void
    gather(const Vector &field, std::vector<double> &unknowns) const
    {
      const std::vector<unsigned int> &own = list();
      unknowns.resize(own.size());
      for (std::size_t i = 0; i < own.size(); ++i)
        unknowns[i] = field[own[i]];
    }

    /// field += factor * unknowns, at the unknowns. This and the functions below are collective.
    void
    add(const double factor, const std::vector<double> &unknowns, Vector &field) const
    {
      const std::vector<unsigned int> &own = list();
      for (std::size_t i = 0; i < own.size(); ++i)
        field[own[i]] += factor * unknowns[i];
      with_others.share(field);
    }

    /// Assemble columns: from partial sums by local_list() to full ones by list(). `n_columns` is
    /// an argument because the columns of a process without free degrees of freedom do not tell it.
    void
    assemble_columns(std::vector<double> &columns, std::size_t n_columns) const;

    /// Gather values by unknown for the whole body at the root, in the order of a single process.
    std::vector<double>
    whole(const std::vector<double> &unknowns) const;

    /// The entries of a whole() at this process' unknowns.
    std::vector<double>
    part(const std::vector<double> &whole) const;

  private:
    /// 1 where a degree of freedom is an unknown of some process, else 0; for the whole body.
    std::vector<double>
    whole_mask(bool everywhere) const;

    std::vector<int>          index;
    std::vector<unsigned int> dofs;
    std::vector<int>          own_index; ///< index in list(), or `held`
    std::vector<unsigned int> own_dofs;
    const Exchange           &with_others;
    unsigned int              n_reinits = 0;
  };
} // namespace Exemplar

#endif
