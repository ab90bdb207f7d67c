// SPDX-License-Identifier: GPL-3.0-or-later
// Formats: .mdd (Newtek Motion Designer), big endian: counts of samples and of points as 32-bit
// integers, the times [s], then the points of each sample, all as 32-bit floats. .pc2 (3ds Max
// Point Cache 2), little endian: "POINTCACHE2" and a zero, version 1, count of points, first frame
// and frames a sample as floats, count of samples; then the points.
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/number_text.h>
#include <exemplar/surface/files/numbered_files.h>
#include <exemplar/surface/files/point_cache.h>
#include <exemplar/surface/files/surface_scanner.h>
#include <exemplar/surface/shape/surface_poses.h>

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

namespace Exemplar
{
  namespace
  {
    const char *const export_remedy
        = " Export the cache of this surface anew, its modifiers switched off that add or remove "
          "vertices.";

    void
    require_increasing(const std::vector<double> &times, const std::string &name)
    {
      if (times.empty())
        throw UserError(name + ": the cache has no samples." + export_remedy);
      for (std::size_t k = 0; k < times.size(); ++k)
        if (!std::isfinite(times[k]) || (k > 0 && !(times[k] > times[k - 1])))
          throw UserError(fmt::format("{}: the time of sample {} of {} is {} Times must increase: "
                                      "look at the exporter's frames and rate.",
                                      name, k + 1, times.size(),
                                      std::isfinite(times[k]) ? fmt::format(
                                          "{} s, not after that of the one before, {} s.",
                                          shortest_text(times[k]), shortest_text(times[k - 1]))
                                                              : "no finite number."));
    }

    void
    require_count(const double       found,
                  const SurfaceMesh &rest,
                  const std::string &rest_name,
                  const std::string &name)
    {
      if (found != static_cast<double>(rest.vertices.size()))
        throw UserError(fmt::format("{}: the cache moves {} vertices, but {} has {}.{}", name,
                                    shortest_text(found), rest_name, rest.vertices.size(),
                                    export_remedy));
    }

    /// The header of a file of points, and its bytes.
    struct PointFile
    {
      std::shared_ptr<SurfaceScanner> in;
      std::vector<double>             times;
      std::size_t                     n_points;
      std::size_t                     begin; ///< byte of the first point
    };

    class FileCache : public PointCache
    {
    public:
      FileCache(PointFile points, const std::string &file_name)
          : PointCache(std::move(points.times)), in(std::move(points.in)),
            n_points(points.n_points), begin(points.begin), name(file_name)
      {
      }

      Vertices
      sample(const std::size_t k) const override
      {
        in->go_to(begin + 12 * n_points * k);
        Vertices vertices(n_points);
        for (std::size_t v = 0; v < n_points; ++v)
          for (double &x : vertices[v])
          {
            x = static_cast<double>(in->raw<float>());
            if (!std::isfinite(x))
              throw UserError(fmt::format("{}: in sample {} of {}, vertex {} is at no finite "
                                          "place. Mend the rig there, and export it anew.",
                                          name, k + 1, get_times().size(), v + 1));
          }
        return vertices;
      }

    private:
      const std::shared_ptr<SurfaceScanner> in;
      const std::size_t                     n_points, begin;
      const std::string                     name;
    };

    /// The points must take up the rest of the file.
    void
    require_points(PointFile &points, const std::size_t n_samples, const std::string &name)
    {
      const std::size_t size = points.in->all().size();
      points.begin           = size - points.in->n_bytes_left();
      const double expected
          = 12. * static_cast<double>(points.n_points) * static_cast<double>(n_samples);
      if (static_cast<double>(size - points.begin) != expected)
        throw UserError(fmt::format(
            "{}: by its header there are {} samples of {} vertices, but the file is {}: its size "
            "is {} bytes, not {}. Save or copy it anew.",
            name, n_samples, points.n_points,
            static_cast<double>(size - points.begin) < expected ? "truncated" : "longer", size,
            shortest_text(expected + static_cast<double>(points.begin))));
    }

    std::size_t
    read_count(SurfaceScanner &in, const std::string &name, const std::string &what)
    {
      const auto n = in.raw<std::int32_t>();
      if (n < 0)
        throw UserError(fmt::format("{}: a count of {} of {} is none; this is no such cache.{}",
                                    name, what, n, export_remedy));
      return static_cast<std::size_t>(n);
    }

    PointFile
    open_mdd(const std::string &name, const SurfaceMesh &rest, const std::string &rest_name)
    {
      PointFile       points{ std::make_shared<SurfaceScanner>(name), {}, 0, 0 };
      SurfaceScanner &in = *points.in;
      if (in.all().substr(0, 11) == "POINTCACHE2")
        throw UserError(
            name
            + ": begins with POINTCACHE2, so it is a .pc2 file. Give it a name that ends in .pc2.");
      in.begin_binary(true);
      in.begin_count(2, "counts of its header");
      const std::size_t n_samples = read_count(in, name, "samples");
      points.n_points             = read_count(in, name, "vertices");
      require_count(static_cast<double>(points.n_points), rest, rest_name, name);
      in.begin_count(n_samples, "times");
      for (std::size_t k = 0; k < n_samples; ++k, in.count())
        points.times.push_back(static_cast<double>(in.raw<float>()));
      require_increasing(points.times, name);
      require_points(points, n_samples, name);
      return points;
    }

    PointFile
    open_pc2(const std::string &name,
             const double       frames_per_second,
             const SurfaceMesh &rest,
             const std::string &rest_name)
    {
      PointFile       points{ std::make_shared<SurfaceScanner>(name), {}, 0, 0 };
      SurfaceScanner &in = *points.in;
      in.begin_binary(false);
      in.begin_count(32, "bytes of its header");
      if (in.all().substr(0, 11) != "POINTCACHE2")
        throw UserError(name
                        + ": does not begin with POINTCACHE2, so it is no .pc2 file. If it is a "
                          ".mdd file, give it a "
                          "name that ends so."
                        + export_remedy);
      in.go_to(12);
      if (const auto version = in.raw<std::int32_t>(); version != 1)
        throw UserError(fmt::format(
            "{}: version {} of .pc2 files is not known, 1 is. Is it a file of this format?", name,
            version));
      points.n_points = read_count(in, name, "vertices");
      require_count(static_cast<double>(points.n_points), rest, rest_name, name);
      const auto        first = static_cast<double>(in.raw<float>());
      const auto        rate  = static_cast<double>(in.raw<float>());
      const std::size_t n     = read_count(in, name, "samples");
      require_points(points, n, name); // checked before n times are allocated
      for (std::size_t k = 0; k < n; ++k)
        points.times.push_back((first + static_cast<double>(k) * rate) / frames_per_second);
      require_increasing(points.times, name);
      return points;
    }

    class SequenceCache : public PointCache
    {
    public:
      SequenceCache(std::vector<std::filesystem::path> sequence,
                    std::vector<double>                times,
                    const SurfaceMesh                 &surface_at_rest,
                    const std::string                 &surface_name)
          : PointCache(std::move(times)), files(std::move(sequence)), rest(surface_at_rest),
            rest_name(surface_name)
      {
      }

      Vertices
      sample(const std::size_t k) const override
      {
        SurfaceMesh surface = read_surface(files[k]);
        check_same_order(rest, rest_name, surface, files[k].string());
        return std::move(surface.vertices);
      }

      std::string
      name_of(const std::size_t k) const override
      {
        return files[k].string();
      }

    private:
      const std::vector<std::filesystem::path> files;
      const SurfaceMesh                       &rest;
      const std::string                        rest_name;
    };

    /// The last number in a file's name.
    double
    frame_number(const std::filesystem::path &file)
    {
      const std::string stem = file.stem().string();
      const auto        last = stem.find_last_of("0123456789");
      if (last == std::string::npos)
        throw UserError(file.string()
                        + ": the files of a sequence need numbers, which are their frames. Name "
                          "them like rig_0001.obj.");
      const auto before = stem.find_last_not_of("0123456789", last);
      const auto first  = before == std::string::npos ? 0 : before + 1;
      return parse_number(stem.substr(first, last - first + 1));
    }

    std::unique_ptr<const PointCache>
    open_sequence(const std::string &pattern,
                  const double       frames_per_second,
                  const SurfaceMesh &rest,
                  const std::string &rest_name)
    {
      auto                files = expand_patterns({ pattern });
      std::vector<double> times;
      for (const auto &file : files)
        times.push_back((frame_number(file) - frame_number(files[0])) / frames_per_second);
      require_increasing(times, pattern);
      return std::make_unique<SequenceCache>(std::move(files), std::move(times), rest, rest_name);
    }
  } // namespace

  std::string
  PointCache::name_of(const std::size_t k) const
  {
    return fmt::format("sample {}", k + 1);
  }

  std::unique_ptr<const PointCache>
  open_point_cache(const std::string &file,
                   const double       frames_per_second,
                   const SurfaceMesh &rest,
                   const std::string &rest_name)
  {
    std::string extension = std::filesystem::path(file).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool is_one_file = extension == ".mdd" || extension == ".pc2";
    if (is_one_file && !std::filesystem::is_regular_file(file))
      throw UserError(file + ": there is no such file. Give the point cache that is to be followed."
                      + missing_file_remedy(file));
    if (extension == ".mdd")
      return std::make_unique<FileCache>(open_mdd(file, rest, rest_name), file);
    if (extension == ".pc2")
      return std::make_unique<FileCache>(open_pc2(file, frames_per_second, rest, rest_name), file);
    if (extension == ".obj" || extension == ".ply" || extension == ".stl")
      return open_sequence(file, frames_per_second, rest, rest_name);
    throw UserError(file
                    + ": a point cache is a .mdd or .pc2 file, or a sequence of surfaces such as "
                      "rig_*.obj. Export it in one of these formats.");
  }
} // namespace Exemplar
