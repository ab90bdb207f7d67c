// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/free_dofs.h>
#include <exemplar/algebra/long_vectors.h>

#include <algorithm>

namespace Exemplar
{
  void
  FreeDofs::reinit(const std::vector<unsigned int> &held_dofs)
  {
    ++n_reinits;
    dofs.clear();
    own_dofs.clear();
    std::fill(index.begin(), index.end(), 0);
    std::fill(own_index.begin(), own_index.end(), held);
    for (const unsigned int dof : held_dofs)
      index[dof] = held;
    for (unsigned int dof = 0; dof < n_dofs(); ++dof)
      if (index[dof] != held)
      {
        index[dof] = static_cast<int>(dofs.size());
        dofs.push_back(dof);
        if (!with_others.owns(dof / 3))
          continue;
        own_index[dof] = static_cast<int>(own_dofs.size());
        own_dofs.push_back(dof);
      }
  }

  double
  FreeDofs::max_magnitude(const Vector &field) const
  {
    MaxMagnitude maximum;
    for (const unsigned int dof : own_dofs)
      maximum.add(field[dof]);
    return with_others.max(maximum.value());
  }

  void
  FreeDofs::assemble_columns(std::vector<double> &columns, const std::size_t n_columns) const
  {
    std::vector<double> assembled, unknowns;
    Vector              field(n_dofs());
    for (std::size_t column = 0; column < n_columns; ++column)
    {
      field = 0.;
      for (std::size_t i = 0; i < dofs.size(); ++i)
        field[dofs[i]] = columns[column * dofs.size() + i];
      with_others.assemble(field.begin(), 3);
      gather(field, unknowns);
      assembled.insert(assembled.end(), unknowns.begin(), unknowns.end());
    }
    columns = std::move(assembled);
  }

  std::vector<double>
  FreeDofs::whole_mask(const bool everywhere) const
  {
    std::vector<double> mask(n_dofs(), 0.);
    for (const unsigned int dof : dofs)
      mask[dof] = 1.;
    return with_others.whole(mask.data(), 3, n_dofs() / 3, everywhere);
  }

  std::vector<double>
  FreeDofs::whole(const std::vector<double> &unknowns) const
  {
    Vector field(n_dofs());
    for (std::size_t i = 0; i < own_dofs.size(); ++i)
      field[own_dofs[i]] = unknowns[i];
    const std::vector<double> all  = with_others.whole(field.begin(), 3, n_dofs() / 3, false);
    const std::vector<double> mask = whole_mask(false);
    std::vector<double>       free;
    for (std::size_t dof = 0; dof < all.size(); ++dof)
      if (mask[dof] > 0.)
        free.push_back(all[dof]);
    return free;
  }

  std::vector<double>
  FreeDofs::part(const std::vector<double> &whole) const
  {
    std::vector<double> field = whole_mask(true);
    for (std::size_t dof = 0, i = 0; dof < field.size(); ++dof)
      if (field[dof] > 0. && i < whole.size())
        field[dof] = whole[i++];
    field = with_others.part(std::move(field), 3);
    std::vector<double> unknowns;
    for (const unsigned int dof : own_dofs)
      unknowns.push_back(field[dof]);
    return unknowns;
  }
} // namespace Exemplar
