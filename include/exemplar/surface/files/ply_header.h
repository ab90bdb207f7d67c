// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_ply_header_h
#define exemplar_ply_header_h

#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  class SurfaceScanner;

  /// A type of numbers in a .ply file.
  enum class PlyType
  {
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    float32,
    float64
  };

  /// A number, or a list of numbers, that each element of a kind has.
  struct PlyProperty
  {
    std::string            name;
    PlyType                type;
    std::optional<PlyType> count; ///< type of a list's length; none for a single number
  };

  /// A kind of elements, vertices for instance, and how many there are.
  struct PlyElement
  {
    std::string              name;
    std::size_t              n;
    std::vector<PlyProperty> properties;

    /// The first property of one of these names, lists or not; their number if there is none.
    template <typename Names>
    std::size_t
    find(const Names &names, const bool list) const
    {
      for (const std::string_view name : names)
        for (std::size_t p = 0; p < properties.size(); ++p)
          if (properties[p].name == name && properties[p].count.has_value() == list)
            return p;
      return properties.size();
    }
  };

  /// The header of a .ply file.
  struct PlyHeader
  {
    std::vector<PlyElement> elements; ///< in the file's order
    bool                    ascii   = true;
    bool                    swapped = false; ///< big endian
  };

  /// Read up to the line end_header. Throws UserError, by way of the scanner, with the line.
  PlyHeader
  read_ply_header(SurfaceScanner &in);
} // namespace Exemplar

#endif
