// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_vtu_parts_h
#define exemplar_vtu_parts_h

#include <exemplar/run/frames/frame_writer.h>

#include <cstddef>
#include <filesystem>
#include <ostream>
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

  /// Write the collection of frames that ParaView opens.
  void
  write_collection(const std::vector<WrittenFrame> &frames, const std::filesystem::path &file);
} // namespace Exemplar

#endif
