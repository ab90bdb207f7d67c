// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/free_dofs.h>

namespace Exemplar
{
  void
  FreeDofs::assemble_columns(std::vector<double> &columns) const
  {
    if (own_index.empty() || dofs.empty())
      return;
    const std::size_t   n_columns = columns.size() / dofs.size();
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
    if (own_index.empty())
      return unknowns;
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
    if (own_index.empty())
      return whole;
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
