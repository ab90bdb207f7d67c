// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/number_text.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/study/study_measures.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>

namespace Exemplar
{
  namespace
  {
    const double nan = std::numeric_limits<double>::quiet_NaN();

    /// Reads the rows of statistics.csv, whose cells hold no commas, one after the other.
    class StatisticsReader
    {
    public:
      explicit StatisticsReader(const std::filesystem::path &file) : in(file)
      {
        next();
        columns = cells;
      }

      /// Go to the next row; returns false at the end. A last line that a crash has truncated is
      /// skipped.
      bool
      next()
      {
        std::string line;
        if (!std::getline(in, line) || in.eof())
          return false;
        cells = split_trimmed(line, ',');
        return true;
      }

      /// A cell of the row; empty if the column is missing.
      std::string
      cell(const std::string &column) const
      {
        const auto found = std::find(columns.begin(), columns.end(), column);
        const auto index = static_cast<std::size_t>(found - columns.begin());
        return index < columns.size() && index < cells.size() ? cells[index] : "";
      }

      /// A number of the row; `absent` if the cell is missing or no number.
      double
      number(const std::string &column, const double absent) const
      {
        const double value = parse_number(cell(column));
        return std::isnan(value) ? absent : value;
      }

    private:
      std::ifstream            in;
      std::vector<std::string> columns;
      std::vector<std::string> cells;
    };

    double
    total_energy(const StatisticsReader &row)
    {
      return row.number("energy_elastic", nan) + row.number("energy_example", 0.)
             + row.number("energy_kinetic", 0.) + row.number("energy_contact", 0.);
    }

    double
    total_work(const StatisticsReader &row)
    {
      return row.number("work_handles", 0.) + row.number("work_gravity", 0.)
             + row.number("work_loads", 0.);
    }

    /// The energy bound of implicit Euler, row by row.
    class EnergyBound
    {
    public:
      /// Excess of a step over the bound [J]; NaN in the first row, if handles have moved, and if
      /// the bound does not apply.
      double
      excess_of_step(const StatisticsReader &row)
      {
        const double handles = row.number("work_handles", 0.);
        const double before  = bound - work;
        const bool   at_rest = handles == handles_before && row.cell("status") != "one pass";
        handles_before       = handles;
        work                 = row.number("work_gravity", 0.) + row.number("work_loads", 0.);
        bound                = total_energy(row);
        const double left
            = bound - row.number("energy_kinetic", 0.) + row.number("energy_inertia", nan);
        return at_rest ? left - work - before : nan;
      }

    private:
      double handles_before = nan, bound = nan, work = nan;
    };

    /// Finds points whose coordinates agree up to rounding.
    class PointIndex
    {
    public:
      PointIndex(const std::vector<dealii::Point<3>> &points, const double tolerance)
          : tolerance(tolerance)
      {
        for (unsigned int i = 0; i < points.size(); ++i)
          indices[box_of(points[i], 0.)] = i;
      }

      std::optional<unsigned int>
      find(const dealii::Point<3> &point) const
      {
        for (unsigned int corner = 0; corner < 8; ++corner) // also look in adjacent boxes
        {
          const auto found = indices.find(box_of(point, 0.5, corner));
          if (found != indices.end())
            return found->second;
        }
        return std::nullopt;
      }

    private:
      using Box = std::array<long long, 3>;

      Box
      box_of(const dealii::Point<3> &point, const double shift, const unsigned int corner = 0) const
      {
        Box box;
        for (unsigned int c = 0; c < 3; ++c)
          box[c] = static_cast<long long>(
              std::floor(point[c] / tolerance + ((corner >> c & 1u) != 0 ? shift : -shift)));
        return box;
      }

      const double                tolerance;
      std::map<Box, unsigned int> indices;
    };

    double
    extent(const std::vector<dealii::Point<3>> &points)
    {
      double maximum = 0.;
      for (const auto &point : points)
        maximum = std::max(maximum, point.distance(points[0]));
      return maximum;
    }

    /// The reference's node for each node of `pose`; empty if one has none.
    std::vector<unsigned int>
    match(const FinalPose &pose, const FinalPose &reference)
    {
      const PointIndex          index(reference.rest, 1e-9 * extent(reference.rest));
      std::vector<unsigned int> matches;
      for (const auto &point : pose.rest)
        if (const auto found = index.find(point))
          matches.push_back(*found);
        else
          return {};
      return matches;
    }
  } // namespace

  RunStatistics
  read_run_statistics(const std::filesystem::path &file)
  {
    RunStatistics    run;
    StatisticsReader row(file);
    double           first_energy = nan, scale = 0., growth = 0., excess = nan;
    EnergyBound      bound;
    while (row.next())
    {
      run.iterations      = std::fmax(run.iterations, 0.) + row.number("iterations", 0.);
      run.residual        = std::fmax(run.residual, row.number("residual", nan));
      run.kkt             = std::fmax(run.kkt, row.number("kkt_residual", nan));
      const double energy = total_energy(row);
      if (std::isnan(energy)) // a failed step
        continue;
      if (std::isnan(first_energy))
        first_energy = energy;
      run.steps     = row.number("step", 0.);
      run.energy    = energy;
      run.min_det_F = std::fmin(run.min_det_F, row.number("min_det_F", nan));
      growth        = std::max(growth, energy - first_energy - total_work(row));
      excess        = std::fmax(excess, bound.excess_of_step(row));
      scale         = std::max({ scale, std::abs(first_energy), std::abs(total_work(row)) });
    }
    if (scale > 0.)
    {
      run.energy_growth = growth / scale;
      run.bound_excess  = excess / scale;
    }
    return run;
  }

  std::vector<double>
  read_last_values(const std::filesystem::path &file, const std::vector<std::string> &columns)
  {
    std::vector<double> values(columns.size(), nan);
    StatisticsReader    row(file);
    while (row.next())
      for (unsigned int i = 0; i < columns.size(); ++i)
        values[i] = row.number(columns[i], nan);
    return values;
  }

  RunSummary
  read_run_summary(const std::filesystem::path &file)
  {
    std::ifstream in(file);
    if (!in)
      return {};
    const auto json   = nlohmann::json::parse(in, nullptr, false); // empty if damaged
    const auto number = [&](const char *key)
    {
      if (!json.is_object() || !json.contains(key))
        return nan;
      return json[key].is_null()     ? std::numeric_limits<double>::infinity()
             : json[key].is_number() ? json[key].get<double>()
                                     : nan;
    };
    return { number("factorizations"), number("condition_matrix"), number("condition_schur"),
             number("peak_memory_mib") };
  }

  PoseErrors
  pose_errors(const FinalPose &pose, const FinalPose &reference)
  {
    PoseErrors                      errors;
    const std::vector<unsigned int> matches = match(pose, reference);
    double difference = 0., displacement = 0., max_difference = 0., max_displacement = 0.;
    for (unsigned int i = 0; i < matches.size(); ++i)
    {
      const unsigned int j     = matches[i];
      const double       error = pose.positions[i].distance(reference.positions[j]);
      const double       scale = reference.positions[j].distance(reference.rest[j]);
      difference += pose.volumes[i] * error * error;
      displacement += pose.volumes[i] * scale * scale;
      max_difference   = std::max(max_difference, error);
      max_displacement = std::max(max_displacement, scale);
    }
    if (max_displacement > 0.)
    {
      errors.l2  = std::sqrt(difference / displacement);
      errors.max = max_difference / max_displacement;
    }
    return errors;
  }
} // namespace Exemplar
