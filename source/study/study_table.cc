// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/text_file.h>
#include <exemplar/study/study_table.h>

#include <cmath>
#include <set>

namespace Exemplar
{
  namespace
  {
    const double not_a_number = std::numeric_limits<double>::quiet_NaN();

    bool
    is_numeric(const StudyAxis &axis)
    {
      for (unsigned int i = 0; i < axis.values.size(); ++i)
        if (std::isnan(number_of(axis, i)))
          return false;
      return axis.values.size() > 1;
    }

    std::string
    condition_text(const double condition)
    {
      return std::isinf(condition) ? "not definite" : shortest_text(condition);
    }

    CsvRow
    csv_row(const StudyTable &table, const StudyRow &row)
    {
      const std::vector<StudyAxis> &axes = table.axes;
      CsvRow                        cells;
      const auto                    append = [&](const std::string &column, const double value)
      { cells.emplace_back(column, shortest_text(value)); };
      for (unsigned int a = 0; a < axes.size(); ++a)
        for (unsigned int k = 0; k < axes[a].keys.size(); ++k)
          cells.emplace_back(axes[a].keys[k], axes[a].values[row.choice[a]][k]);
      cells.emplace_back("status", row.status);
      append("error_position_l2", row.errors.l2);
      append("error_position_max", row.errors.max);
      append("error_energy", row.error_energy);
      append("seconds_median", row.seconds.median);
      append("seconds_min", row.seconds.minimum);
      append("steps", row.statistics.steps);
      append("iterations", row.statistics.iterations);
      append("factorizations", row.summary.factorizations);
      append("residual", row.statistics.residual);
      append("kkt_residual", row.statistics.kkt);
      cells.emplace_back("condition_matrix", condition_text(row.summary.condition_matrix));
      cells.emplace_back("condition_schur", condition_text(row.summary.condition_schur));
      append("min_det_F", row.statistics.min_det_F);
      append("energy_growth", row.statistics.energy_growth);
      append("bound_excess", row.statistics.bound_excess);
      append("max_displacement", row.max_displacement);
      append("peak_memory_mib", row.summary.peak_memory);
      for (unsigned int i = 0; i < table.extra_columns.size(); ++i)
        append(table.extra_columns[i], row.extra[i]);
      append("exit_status", row.exit_status);
      cells.emplace_back("run", row.run);
      cells.emplace_back("message", row.message);
      return cells;
    }
  } // namespace

  double
  number_of(const StudyAxis &axis, const unsigned int choice)
  {
    const std::vector<std::string> parts = split_trimmed(axis.values[choice][0], ',');
    if (parts.size() == 1)
      return parse_number(parts[0]);
    double product = 1.;
    for (const std::string &part : parts)
      product *= parse_number(part);
    return std::pow(product, 1. / static_cast<double>(parts.size()));
  }

  std::optional<unsigned int>
  numeric_axis(const std::vector<StudyAxis> &axes)
  {
    for (unsigned int a = 0; a < axes.size(); ++a)
      if (is_numeric(axes[a]))
        return a;
    return std::nullopt;
  }

  std::vector<StudyLine>
  lines_of(const StudyTable &table)
  {
    const std::optional<unsigned int> numeric = numeric_axis(table.axes);
    std::vector<StudyLine>            lines;
    for (const StudyRow &row : table.rows)
    {
      std::vector<unsigned int> choice;
      std::string               title;
      for (unsigned int a = 0; numeric && a < table.axes.size(); ++a)
        if (a != *numeric)
        {
          choice.push_back(row.choice[a]);
          title += (title.empty() ? "" : ", ") + table.axes[a].text(row.choice[a]);
        }
      unsigned int l = 0;
      while (l < lines.size() && lines[l].choice != choice)
        ++l;
      if (l == lines.size())
        lines.push_back({ choice, title, {} });
      lines[l].rows.push_back(&row);
    }
    return lines;
  }

  double
  observed_order(const double error_1,
                 const double error_2,
                 const double number_1,
                 const double number_2)
  {
    const double order = std::log(error_1 / error_2) / std::log(number_1 / number_2);
    return std::isfinite(order) ? order : not_a_number;
  }

  std::vector<std::string>
  extra_columns_of(const Study &study)
  {
    std::vector<std::string> columns = study.columns;
    if (study.probe)
      columns.insert(columns.end(), { "probe_x", "probe_y", "probe_z" });
    return columns;
  }

  void
  check_extra_columns(const Study &study)
  {
    StudyRow row;
    row.choice.assign(study.axes.size(), 0);
    std::set<std::string> taken;
    for (const auto &[name, value] : csv_row({ study.axes, {} }, row))
      taken.insert(name);
    for (const std::string &column : extra_columns_of(study))
      if (!taken.insert(column).second)
        throw UserError(study.file.string() + ": Columns: the study's table has a column " + column
                        + " of its own. Remove it from Columns.");
  }

  void
  write_study_csv(const StudyTable &table, const std::filesystem::path &file)
  {
    AtomicFile atomic_file(file);
    write_csv_header(atomic_file.stream(), csv_row(table, table.rows.at(0)));
    for (const StudyRow &row : table.rows)
      write_csv_cells(atomic_file.stream(), csv_row(table, row));
    atomic_file.commit();
  }
} // namespace Exemplar
