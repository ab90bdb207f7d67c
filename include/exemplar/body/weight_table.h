// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_weight_table_h
#define exemplar_weight_table_h

#include <exemplar/body/example_parameters.h>

#include <filesystem>
#include <vector>

namespace Exemplar
{
  /// Weights at given times: linear between them, and constant before the first and after the last.
  struct WeightTable
  {
    std::vector<double> times; ///< t of the scene, ascending; empty: no table

    /// Weights of all examples at each time, the rest pose first where it is included. They sum to one.
    std::vector<std::vector<double>> weights;

    bool
    empty() const
    {
      return times.empty();
    }

    /// Weights at time t. Requires a table that is not empty.
    std::vector<double>
    at(double time) const;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &times &weights;
    }
  };

  /// Reads Examples/Weights file, a table in CSV with the columns t and one per example, under names or without
  /// these. The column of the rest pose may be missing: its weight is 1 minus the others. Throws UserError, with the
  /// line, for a file that cannot be read or does not suit the examples.
  WeightTable
  read_weight_table(const std::filesystem::path &file, const ExampleParameters &examples);
} // namespace Exemplar

#endif
