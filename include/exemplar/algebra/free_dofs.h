// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_free_dofs_h
#define exemplar_free_dofs_h

#include <exemplar/algebra/exchange.h>
#include <exemplar/algebra/vector.h>

#include <vector>

namespace Exemplar
{
  /// The degrees of freedom that a solve determines. Degree of freedom 3 i + c is component c of
  /// node i; held ones are no unknowns of the linear system. Processes that share a body assemble
  /// for all free ones that they have, of which each is the unknown of one process. Which are held
  /// may change between steps.
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

    /// From now on these are held. All processes must call this.
    void
    reinit(const std::vector<unsigned int> &held_dofs);

    /// How often reinit() has been called: whoever remembers this number knows whether what he has
    /// made of the degrees of freedom is still theirs.
    unsigned int
    version() const
    {
      return n_reinits;
    }

    /// Unknowns of this process.
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

    /// With the processes that have the other degrees of freedom of the body.
    const Exchange &
    exchange() const
    {
      return with_others;
    }

    /// The unknowns of this process in ascending order: all free degrees of freedom of its nodes,
    /// unless others own some of these.
    const std::vector<unsigned int> &
    list() const
    {
      return own_dofs;
    }

    /// Number in list(), or `held` for what is no unknown of this process.
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

    /// Number in local_list(), or `held`.
    int
    free_index(const unsigned int dof) const
    {
      return index[dof];
    }

    /// The greatest magnitude of a field at the unknowns of all processes, which all must call.
    double
    max_magnitude(const Vector &field) const;

    /// The unknowns among a field.
    void
    gather(const Vector &field, std::vector<double> &unknowns) const
    {
      const std::vector<unsigned int> &own = list();
      unknowns.resize(own.size());
      for (std::size_t i = 0; i < own.size(); ++i)
        unknowns[i] = field[own[i]];
    }

    /// Add a factor times numbers by unknown to a field. All processes must call this and the
    /// functions below.
    void
    add(const double factor, const std::vector<double> &unknowns, Vector &field) const
    {
      const std::vector<unsigned int> &own = list();
      for (std::size_t i = 0; i < own.size(); ++i)
        field[own[i]] += factor * unknowns[i];
      with_others.share(field);
    }

    /// Columns that this process' cells have summed, by local_list(), become those of the body, by
    /// list(). Where a process has nothing to move, they do not tell how many there are.
    void
    assemble_columns(std::vector<double> &columns, std::size_t n_columns) const;

    /// Numbers by unknown, for the whole body at the root, in the order of one process.
    std::vector<double>
    whole(const std::vector<double> &unknowns) const;

    /// What of a whole() are unknowns of this process.
    std::vector<double>
    part(const std::vector<double> &whole) const;

  private:
    /// 1 where a degree of freedom is an unknown of some process, else 0; for the whole body.
    std::vector<double>
    whole_mask(bool everywhere) const;

    std::vector<int>          index;
    std::vector<unsigned int> dofs;
    std::vector<int>          own_index; ///< of those that this process owns
    std::vector<unsigned int> own_dofs;
    const Exchange           &with_others;
    unsigned int              n_reinits = 0;
  };
} // namespace Exemplar

#endif
