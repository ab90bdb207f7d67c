// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/frames/frame_writer.h>
#include <exemplar/surface/files/write_obj.h>

namespace Exemplar
{
  namespace
  {
    /// Writes the surface of the body as Wavefront .obj.
    class ObjWriter : public FrameWriter
    {
    public:
      explicit ObjWriter(const SurfaceMesh &surface) : faces(obj_faces(surface)) {}

      void
      write(const Frame &frame, const std::filesystem::path &file) const override
      {
        AtomicFile atomic_file(file);
        atomic_file.stream() << "# a frame by exemplar\n" << obj_vertices(frame.surface) << faces;
        atomic_file.commit_without_sync();
      }

      void
      write_animation(const std::vector<WrittenFrame> &,
                      const std::filesystem::path &) const override
      {
      }

    private:
      const std::string faces; ///< all lines after the vertices; the same in all frames
    };
  } // namespace

  std::unique_ptr<const FrameWriter>
  make_obj_writer(const FrameSubject &subject)
  {
    return std::make_unique<const ObjWriter>(*subject.surface);
  }
} // namespace Exemplar
