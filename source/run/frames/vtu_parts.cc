// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/run/frames/vtu_parts.h>

#include <deal.II/base/utilities.h>

#include <cstdint>
#include <cstring>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <zlib.h>

namespace Exemplar
{
  std::string
  encode_binary(const void *data, const std::size_t size)
  {
    uLongf                     compressed_size = compressBound(size);
    std::vector<unsigned char> compressed(compressed_size);
    if (compress2(compressed.data(), &compressed_size, static_cast<const Bytef *>(data), size,
                  Z_BEST_SPEED)
        != Z_OK)
      throw std::runtime_error("zlib cannot compress a frame");
    compressed.resize(compressed_size);

    const std::uint64_t        header[4] = { 1, size, size, compressed_size };
    std::vector<unsigned char> header_bytes(sizeof(header));
    std::memcpy(header_bytes.data(), header, sizeof(header));
    return dealii::Utilities::encode_base64(header_bytes)
           + dealii::Utilities::encode_base64(compressed);
  }

  std::string
  head_of_grid()
  {
    std::ostringstream out;
    out << "<?xml version=\"1.0\"?>\n"
        << "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
           "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n"
        << "<UnstructuredGrid>\n";
    return out.str();
  }

  void
  write_collection(const std::vector<WrittenFrame> &frames, const std::filesystem::path &file)
  {
    AtomicFile    atomic_file(file);
    std::ostream &out = atomic_file.stream();
    out << "<?xml version=\"1.0\"?>\n"
        << "<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n"
        << std::setprecision(12);
    const auto list = [&](const double time, const char *const part, const auto &of)
    {
      out << "<DataSet timestep=\"" << time << part << "\" file=\"" << of.filename().string()
          << "\"/>\n";
    };
    for (const auto &[time, frame, obstacles] : frames)
    {
      list(time, obstacles.empty() ? "" : "\" part=\"0", frame);
      if (!obstacles.empty())
        list(time, "\" part=\"1", obstacles);
    }
    out << "</Collection>\n</VTKFile>\n";
    atomic_file.commit();
  }
} // namespace Exemplar
