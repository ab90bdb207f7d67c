// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_selection_h
#define exemplar_selection_h

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace Exemplar
{
  class KeyTable;
  class Mesh;
  struct BoundaryFace;
  using NamedNodes = std::map<std::string, std::vector<unsigned int>>;

  /// A set of nodes named in a scene: box x0 y0 z0 x1 y1 z1 | sphere x y z r |
  /// boundary ID | region ID | set ID | nodes FILE, or by the surface of the body: vertex N [within D] |
  /// group NAME | map FILE.
  struct Selection
  {
    std::string text; ///< text of the scene, with an absolute FILE

    void
    declare(KeyTable &keys, const std::string &what);

    /// The text with an absolute file of "nodes FILE" or "map FILE", if `directory` is given; other
    /// selections are unchanged.
    static std::string
    absolute(const std::string &text, const std::filesystem::path &directory);

    bool
    is_boundary() const;

    /// Whether the selection is a box or a sphere.
    bool
    is_of_space() const;

    /// Advice on a box whose six numbers may be ranges of x, y and z instead of two corners: how to
    /// write either. Sentences; empty for other selections.
    std::string
    doubt() const;

    /// Whether the selection needs the surface of the body: its nodes are then found elsewhere and
    /// passed among the named ones, by `text`.
    bool
    is_of_surface() const;

    /// The FILE of "nodes FILE"; empty for other selections.
    std::string
    file() const;

    /// All but the first word of "map FILE:ATTRIBUTE [above X | below X]"; empty for other
    /// selections.
    std::string
    map() const;

    /// The selected nodes in ascending order; `named` contains those of "nodes FILE", by the FILE,
    /// and those of selections by the surface, by their text. `mesh` is a whole one. Throws
    /// UserError, calling the selection `key`, if it is misspelt or selects nothing.
    std::vector<unsigned int>
    choose(const Mesh &mesh, const std::string &key, const NamedNodes &named = {}) const;

    /// The nodes in `named` by the text of this selection, maybe none, or else those of choose().
    std::vector<unsigned int>
    nodes(const Mesh &mesh, const std::string &key, const NamedNodes &named = {}) const;

    /// The faces of "boundary ID", maybe none.
    std::vector<BoundaryFace>
    faces(const Mesh &mesh, const std::string &key) const;
  };
} // namespace Exemplar

#endif
