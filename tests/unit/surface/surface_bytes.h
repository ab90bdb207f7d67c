// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_surface_bytes_h
#define exemplar_tests_surface_bytes_h

#include <exemplar/base/errors.h>
#include <exemplar/surface/shape/surface_mesh.h>

#include "temporary_directory.h"

#include <algorithm>
#include <string>
#include <vector>

// A surface in the bytes of every format.
namespace Exemplar::Testing
{
  /// A test that writes and reads surfaces.
  class SurfaceTest : public InTemporaryDirectory
  {
  protected:
    SurfaceMesh
    read(const std::string &bytes, const std::string &name) const
    {
      return read_surface(write_file(name, bytes));
    }

    /// The message of the UserError that reading gives, "" if there is none.
    std::string
    error_of(const std::string &bytes, const std::string &name) const
    {
      try
      {
        read(bytes, name);
        return "";
      }
      catch (const UserError &error)
      {
        return error.what();
      }
    }
  };

  /// A pyramid with a square base: one face of four vertices and four of three, in two groups.
  inline SurfaceMesh
  pyramid()
  {
    return {
      { { { 0, 0, 0 } }, { { 1, 0, 0 } }, { { 1, 1, 0 } }, { { 0, 1, 0 } }, { { .5, .5, 1.25 } } },
      { { 0, 3, 2, 1 }, { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 3, 0, 4 } },
      { 0, 1, 1, 1, 1 },
      { "3", "7" }
    };
  }

  /// A number's bytes, the highest first or last.
  template <typename Number>
  std::string
  number_bytes(const Number value, const bool big_endian = false)
  {
    std::string bytes(reinterpret_cast<const char *>(&value), sizeof(Number));
    if (big_endian)
      std::reverse(bytes.begin(), bytes.end());
    return bytes;
  }

  /// The pyramid as .ply with properties and elements that say nothing of the surface.
  inline std::string
  ply_header(const std::string &format, const std::string &line_break = "\n")
  {
    std::string text;
    for (const std::string &line :
         std::vector<std::string>{ "ply",
                                   "format " + format + " 1.0",
                                   "comment made by a test",
                                   "element camera 1",
                                   "property double f",
                                   "property list uchar short modes",
                                   "element vertex 5",
                                   "property float nx",
                                   "property double x",
                                   "property float y",
                                   "property float z",
                                   "property uchar red",
                                   "element face 5",
                                   "property list uchar int vertex_indices",
                                   "property list uchar float uv",
                                   "property short label",
                                   "element edge 1",
                                   "property int vertex1",
                                   "property int vertex2",
                                   "end_header" })
      text += line + line_break;
    return text;
  }

  inline std::string
  ascii_ply(const std::string &line_break = "\n")
  {
    const std::string rest = "3.5 2 -1 8|0.1 0 0 0 255|0.1 1 0 0 255|0.1 1 1 0 255|0.1 0 1 0 255|"
                             "0.1 .5 .5 1.25 255|4 0 3 2 1 0 3|3 0 1 4 2 .5 .5 7|3 1 2 4 0 7|"
                             "3 2 3 4 0 7|3 3 0 4 0 7|0 1|";
    std::string       text = ply_header("ascii", line_break);
    for (const char c : rest)
      text += c == '|' ? line_break : std::string(1, c);
    return text;
  }

  inline std::string
  binary_ply(const bool big)
  {
    const SurfaceMesh surface = pyramid();
    std::string       text    = ply_header(big ? "binary_big_endian" : "binary_little_endian")
                       + number_bytes(3.5, big) + '\2' + number_bytes<std::int16_t>(-1, big)
                       + number_bytes<std::int16_t>(8, big);
    for (const auto &vertex : surface.vertices)
      text += number_bytes(.1F, big) + number_bytes(vertex[0], big)
              + number_bytes(static_cast<float>(vertex[1]), big)
              + number_bytes(static_cast<float>(vertex[2]), big) + '\xff';
    for (std::size_t f = 0; f < 5; ++f)
    {
      text += static_cast<char>(surface.faces[f].size());
      for (const unsigned int vertex : surface.faces[f])
        text += number_bytes(static_cast<int>(vertex), big);
      text += '\1' + number_bytes(.5F, big) + number_bytes<std::int16_t>(f == 0 ? 3 : 7, big);
    }
    return text + number_bytes(0, big) + number_bytes(1, big);
  }

  /// The pyramid as .obj with normals and texture coordinates.
  inline const std::string obj_text
      = "# a pyramid\n\nmtllib none.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 .5 .5 .5\nv 0 1 0 "
        "# v\n"
        "v .5 +.5 1.25\nvt 0 0\nvn 0 0 1\ng 3\nusemtl a\nf 1 4 3 2\ng 7\ns off\nf 1/1 2/1 5/1\n"
        "usemtl b\nf 2//1 3//1 5//1\nf -3/1/1 -2/1/1 \\\n  -1/1/1\nf 4 1 5\n";
} // namespace Exemplar::Testing

#endif
