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
  /// boundary ID | region ID | nodes FILE, or by the surface of the body: vertex N [within D] |
  /// group NAME | map FILE.
  struct Selection
  {
    std::string text; ///< as the scene has it; the FILE absolute

    void
    declare(KeyTable &keys, const std::string &what);

    /// Make the file of "nodes FILE" or "map FILE" absolute, if there is a directory to start
    /// from; other selections stay.
    static std::string
    absolute(const std::string &text, const std::filesystem::path &directory);

    bool
    is_boundary() const;

    /// Whether it is a box or a sphere.
    bool
    is_of_space() const;

    /// Of a box whose six numbers may be ranges of x, y and z instead of two corners: what to write for
    /// either. Sentences; empty for other selections.
    std::string
    doubt() const;

    /// Whether it needs the surface of the body: who has that puts the nodes among the named ones,
    /// by `text`.
    bool
    is_of_surface() const;

    /// Of "nodes FILE"; empty for other selections.
    std::string
    file() const;

    /// Of "map FILE:ATTRIBUTE [above X | below X]", all but the first word; empty for other
    /// selections.
    std::string
    map() const;

    /// The selected nodes in ascending order; those of "nodes FILE" are in `named`, by
    /// the FILE, and those of selections by the surface, by their text. `mesh` is a whole one. Throws
    /// UserError, calling the selection `key`, if it is misspelt or selects nothing.
    std::vector<unsigned int>
    choose(const Mesh &mesh, const std::string &key, const NamedNodes &named = {}) const;

    /// The nodes that are in `named` by the text of this selection, maybe none, or else those that
    /// choose() finds.
    std::vector<unsigned int>
    nodes(const Mesh &mesh, const std::string &key, const NamedNodes &named = {}) const;

    /// The faces of "boundary ID", maybe none.
    std::vector<BoundaryFace>
    faces(const Mesh &mesh, const std::string &key) const;
  };
} // namespace Exemplar

#endif
