// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_vtu_parts_h
#define exemplar_vtu_parts_h

#include <exemplar/run/frames/frame_writer.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

// Common parts of files in VTK's XML formats.

namespace Exemplar
{
  /// VTK's "binary" encoding: a header [blocks, block size, size of the last block,
  /// compressed size] and the compressed block, each in base64.
  std::string
  encode_binary(const void *data, std::size_t size);

  template <typename Number>
  void
  write_array(std::ostream      &out,
              const std::string &type,
              const std::string &name,
              const int          n_components,
              const Number      *data,
              const std::size_t  size)
  {
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
        << n_components << "\" format=\"binary\">" << encode_binary(data, size * sizeof(Number))
        << "</DataArray>\n";
  }

  /// The beginning of an unstructured grid's file.
  std::string
  head_of_grid();

  /// The cells of a grid: `nodes_of(cell)` are the points of each.
  template <typename NodesOf>
  std::string
  cells_of_grid(const std::size_t n_cells, const std::uint8_t vtk_type, const NodesOf &nodes_of)
  {
    std::vector<std::int32_t> connectivity, offsets;
    for (unsigned int cell = 0; cell < n_cells; ++cell)
    {
      const auto &nodes = nodes_of(cell);
      connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
      offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
    }
    const std::vector<std::uint8_t> types(n_cells, vtk_type);
    std::ostringstream              out;
    out << "<Cells>\n";
    write_array(out, "Int32", "connectivity", 1, connectivity.data(), connectivity.size());
    write_array(out, "Int32", "offsets", 1, offsets.data(), offsets.size());
    write_array(out, "UInt8", "types", 1, types.data(), types.size());
    out << "</Cells>\n";
    return out.str();
  }

  /// Write the collection of frames that ParaView opens.
  void
  write_collection(const std::vector<WrittenFrame> &frames, const std::filesystem::path &file);
} // namespace Exemplar

#endif
