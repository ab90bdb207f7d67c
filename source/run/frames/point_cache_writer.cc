// SPDX-License-Identifier: GPL-3.0-or-later
// Formats: the readers of Blender's Mesh Cache modifier, MOD_meshcache_mdd.c and
// MOD_meshcache_pc2.c, which go back to NewTek's MDD and to 3ds Max's Point Cache 2.
#include <exemplar/base/atomic_file.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/frames/frame_writer.h>
#include <exemplar/run/frames/raw_bytes.h>
#include <exemplar/run/frames/single_precision.h>

#include <fstream>
#include <stdexcept>

namespace Exemplar
{
  namespace
  {
    /// Header of MDD: numbers of frames and points, times of frames.
    struct Mdd
    {
      static constexpr ByteOrder order = ByteOrder::big;

      static std::string
      head(const std::size_t n_points, const std::vector<double> &times)
      {
        std::string bytes;
        append_raw<order>(bytes, static_cast<std::int32_t>(times.size()));
        append_raw<order>(bytes, static_cast<std::int32_t>(n_points));
        for (const double time : times)
          append_raw<order>(bytes, static_cast<float>(time));
        return bytes;
      }
    };

    /// Header of PC2: signature, version, points, first frame, frames per sample, samples.
    struct Pc2
    {
      static constexpr ByteOrder order = ByteOrder::little;

      static std::string
      head(const std::size_t n_points, const std::vector<double> &times)
      {
        std::string bytes("POINTCACHE2", 12); // with its final zero
        append_raw<order>(bytes, std::int32_t{ 1 });
        append_raw<order>(bytes, static_cast<std::int32_t>(n_points));
        append_raw<order>(bytes, 0.f);
        append_raw<order>(bytes, 1.f);
        append_raw<order>(bytes, static_cast<std::int32_t>(times.size()));
        return bytes;
      }
    };

    /// Writes a header and the vertices' positions, three floats each. A frame is a cache of one
    /// sample; the animation concatenates the frames.
    template <typename Format>
    class PointCacheWriter : public FrameWriter
    {
    public:
      explicit PointCacheWriter(const std::size_t n_points) : n_points(n_points) {}

      void
      write(const Frame &frame, const std::filesystem::path &file) const override
      {
        std::string bytes = Format::head(n_points, { frame.time });
        for (const auto &vertex : frame.surface)
          for (const double coordinate : vertex)
            append_raw<Format::order>(bytes, single_precision(coordinate));
        AtomicFile atomic_file(file);
        atomic_file.stream() << bytes;
        atomic_file.commit_without_sync();
      }

      void
      write_animation(const std::vector<WrittenFrame> &frames,
                      const std::filesystem::path     &file) const override
      {
        std::vector<double> times;
        for (const WrittenFrame &frame : frames)
          times.push_back(frame.time);
        AtomicFile atomic_file(file);
        atomic_file.stream() << Format::head(n_points, times);
        for (const WrittenFrame &frame : frames)
          atomic_file.stream() << points_of(frame.file);
        atomic_file.commit();
      }

    private:
      std::string
      points_of(const std::filesystem::path &file) const
      {
        const std::string expected = Format::head(n_points, { 0. });
        std::string       bytes(expected.size() + 12 * n_points, '\0');
        std::ifstream     in(file, std::ios::binary);
        in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        if (!in || in.peek() != std::char_traits<char>::eof()
            || bytes.compare(0, 8, expected, 0, 8) != 0)
          throw std::runtime_error(
              file.string()
              + " is not the frame that this run has written. Remove it, or run "
                "the scene without --resume.");
        return bytes.substr(expected.size());
      }

      const std::size_t n_points;
    };
  } // namespace

  std::unique_ptr<const FrameWriter>
  make_mdd_writer(const FrameSubject &subject)
  {
    return std::make_unique<const PointCacheWriter<Mdd>>(subject.surface->vertices.size());
  }

  std::unique_ptr<const FrameWriter>
  make_pc2_writer(const FrameSubject &subject)
  {
    return std::make_unique<const PointCacheWriter<Pc2>>(subject.surface->vertices.size());
  }
} // namespace Exemplar
