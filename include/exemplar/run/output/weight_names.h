// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_names_h
#define exemplar_weight_names_h

#include <exemplar/body/example_weights.h>

#include <fmt/core.h>

#include <filesystem>
#include <string>

// What belongs to a weight or to its region is called so in statistics.csv and in the names of files.

namespace Exemplar
{
  /// `prefix`, or `prefix`_R with the region's material id R where weights are by region.
  inline std::string
  name_of_region(const std::string &prefix, const ExamplePoses &poses, const unsigned int region)
  {
    const auto id = poses.get_regions().material_id(region);
    return id ? fmt::format("{}_{}", prefix, *id) : prefix;
  }

  /// The same and _i, of example i.
  inline std::string
  name_of_weight(const std::string &prefix, const ExamplePoses &poses, const unsigned int weight)
  {
    const unsigned int n = poses.size();
    return fmt::format("{}_{}", name_of_region(prefix, poses, weight / n), weight % n);
  }

  /// An example as people call it: its file without folders and ending, "rest", or "formula i".
  inline std::string
  short_name_of_pose(const ExamplePoses &poses, const unsigned int i)
  {
    const std::string &name = poses.name(i);
    return name.find(';') == std::string::npos ? std::filesystem::path(name).stem().string()
                                               : fmt::format("formula {}", i); // which is long
  }
} // namespace Exemplar

#endif
