// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_point_cache_h
#define exemplar_point_cache_h

#include <exemplar/surface/shape/surface_mesh.h>

#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// Vertex positions of a surface over time, such as the output of a rig. Samples are decoded when
  /// they are asked for.
  class PointCache
  {
  public:
    using Vertices = std::vector<SurfaceMesh::Vertex>;

    virtual ~PointCache() = default;

    /// Times of the samples [s]: at least one, ascending.
    const std::vector<double> &
    get_times() const
    {
      return times;
    }

    /// Vertex positions of sample k, in the unit of the surface. Throws UserError for coordinates
    /// that are not finite and, in a sequence of files, for a file that is no pose of the surface.
    virtual Vertices
    sample(std::size_t k) const = 0;

    /// Name of a sample for messages: its file, if each sample has one.
    virtual std::string
    name_of(std::size_t k) const;

  protected:
    explicit PointCache(std::vector<double> sample_times) : times(std::move(sample_times)) {}

  private:
    const std::vector<double> times;
  };

  /// Open the cache of a surface `rest`: a .mdd file, which has its times; a .pc2 file, which
  /// counts in frames; or a sequence of surfaces, `rig_*.obj`, whose last number is the frame, the
  /// first one at t = 0. Throws UserError with the place for a file that is none, is truncated, has
  /// another number of vertices, no sample, or times that do not increase.
  std::unique_ptr<const PointCache>
  open_point_cache(const std::string &file,
                   double             frames_per_second,
                   const SurfaceMesh &rest,
                   const std::string &rest_name);
} // namespace Exemplar

#endif
