// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_names_h
#define exemplar_weight_names_h

#include <exemplar/body/example_weights.h>

#include <fmt/core.h>

#include <filesystem>
#include <string>

// Names of weights and regions in statistics.csv and in file names.

namespace Exemplar
{
  /// `prefix`, or `prefix`_R with the region's material id R where weights are by region.
  inline std::string
  name_of_region(const std::string    &prefix,
                 const ExampleTargets &examples,
                 const unsigned int    region)
  {
    const auto id = examples.region_id(region);
    return id ? fmt::format("{}_{}", prefix, *id) : prefix;
  }

  /// `prefix`_i or `prefix`_R_i of the weight of example i.
  inline std::string
  name_of_weight(const std::string    &prefix,
                 const ExampleTargets &examples,
                 const unsigned int    weight)
  {
    const unsigned int n = examples.size();
    return fmt::format("{}_{}", name_of_region(prefix, examples, weight / n),
                       examples.number(weight % n));
  }

  /// Short name of an example: its file without folders and extension, "rest", or "example i".
  inline std::string
  short_name_of_pose(const ExampleTargets &examples, const unsigned int i)
  {
    const std::string &name = examples.name(i);
    return name.find(';') == std::string::npos
               ? std::filesystem::path(name).stem().string()
               : fmt::format("example {}", examples.number(i)); // a formula is long
  }
} // namespace Exemplar

#endif
