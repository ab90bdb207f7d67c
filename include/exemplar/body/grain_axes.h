// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_grain_axes_h
#define exemplar_grain_axes_h

#include <exemplar/body/material_parameters.h>
#include <exemplar/body/orthotropy.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/selection.h>

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  /// The two selections of a Fibre direction "from SELECTION to SELECTION".
  struct FibreEnds
  {
    Selection from, to;
  };

  /// Parse a Fibre direction into its selections; none for formulas. Throws UserError, calling the
  /// text `key`, for "from" without " to ".
  std::optional<FibreEnds>
  split_fibre_ends(const std::string &text, const std::string &key);

  /// The text of a Fibre direction with absolute paths of the selections' files; formulas are
  /// unchanged.
  std::string
  absolute_fibre_direction(const std::string &text, const std::filesystem::path &directory);

  /// The material axes of each cell at rest; empty if no material has a grain. `mesh` is a whole
  /// one; `named` are the nodes of files and of the surface. `painted` directions, three numbers a
  /// cell, replace those of the parameters. Cells that no way between two selections passes have the directions of their
  /// neighbours, and `warnings` are appended if these are many. Throws UserError for a direction that is 0.
  std::vector<GrainAxes>
  find_grain_axes(const MaterialParameters               &parameters,
                  const Mesh                             &mesh,
                  const NamedNodes                       &named,
                  const std::vector<std::vector<double>> &painted,
                  std::vector<std::string>               &warnings);

  /// The gradient in each cell of the harmonic function that is 0 at the nodes `from` and 1 at the
  /// nodes `to`, by linear elements; exactly 0 in parts of the body connected to neither.
  std::vector<dealii::Tensor<1, 3>>
  harmonic_gradients(const Mesh                      &mesh,
                     const std::vector<unsigned int> &from,
                     const std::vector<unsigned int> &to);
} // namespace Exemplar

#endif
