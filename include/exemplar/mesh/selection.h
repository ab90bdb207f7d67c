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
  /// boundary ID | region ID | nodes FILE.
  struct Selection
  {
    std::string text; ///< as the scene has it; the FILE absolute

    void
    declare(KeyTable &keys, const std::string &what);

    /// Make the file of "nodes FILE" absolute, if there is a directory to start from; other
    /// selections stay.
    static std::string
    absolute(const std::string &text, const std::filesystem::path &directory);

    bool
    is_boundary() const;

    /// Of "nodes FILE"; empty for other selections.
    std::string
    file() const;

    /// The selected nodes in ascending order; those of "nodes FILE" are in `named`. Throws
    /// UserError, calling the selection `key`, if it is misspelt or selects nothing.
    std::vector<unsigned int>
    nodes(const Mesh &mesh, const std::string &key, const NamedNodes &named = {}) const;

    /// The faces of "boundary ID".
    std::vector<BoundaryFace>
    faces(const Mesh &mesh, const std::string &key) const;
  };
} // namespace Exemplar

#endif
