// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/child_process.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/version.h>
#include <exemplar/study/study_report.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iomanip>
#include <map>
#include <sstream>

namespace Exemplar
{
  namespace
  {
    /// The number with three digits, enough for a table; empty if not finite.
    std::string
    rounded(const double value, const int digits = 3)
    {
      if (!std::isfinite(value))
        return "";
      std::ostringstream text;
      text << std::setprecision(digits) << value;
      return text.str();
    }

    std::string
    cell(const std::string &text)
    {
      std::string escaped;
      for (const char c : text)
        escaped += c == '|' ? "\\|" : std::string(1, c);
      return escaped;
    }

    std::string
    settings_text(const std::vector<Assignment> &assignments)
    {
      std::string text;
      for (const Assignment &a : assignments)
        text += (text.empty() ? "`" : ", `") + a.path() + " = " + a.value + "`";
      return text.empty() ? "none" : text;
    }

    void
    write_head(std::ostream &out, const Study &study)
    {
      out << "# Study " << study.file.stem().string() << "\n\n"
          << "- Scene: `" << study.scene.filename().string() << "`\n"
          << "- Set for all runs: " << settings_text(study.base) << '\n'
          << "- Reference: " << settings_text(study.reference) << '\n'
          << "- Seconds: the median of " << study.repeats << (study.repeats == 1 ? " run" : " runs")
          << " on " << study.threads << (study.threads == 1 ? " thread" : " threads")
          << ", time stepping alone\n"
          << "- Program: exemplar " << EXEMPLAR_VERSION << " (" << EXEMPLAR_GIT_REVISION << ")\n";
    }

    /// A column of a table: an error, which has an order, or another number of a row.
    struct Column
    {
      std::string                             title;
      std::function<double(const StudyRow &)> value;
      bool                                    has_order;
    };

    std::vector<Column>
    columns_of(const StudyTable &table)
    {
      const bool          has_reference = table.has_reference;
      std::vector<Column> columns;
      if (has_reference)
        columns
            = { { "position error, L2", [](const StudyRow &row) { return row.errors.l2; }, true },
                { "position error, max", [](const StudyRow &row) { return row.errors.max; }, true },
                { "energy error", [](const StudyRow &row) { return row.error_energy; }, true } };
      columns.insert(
          columns.end(),
          { { "seconds", [](const StudyRow &row) { return row.seconds.median; }, false },
            { "steps", [](const StudyRow &row) { return row.statistics.steps; }, false },
            { "iterations", [](const StudyRow &row) { return row.statistics.iterations; }, false },
            { "factorizations", [](const StudyRow &row) { return row.summary.factorizations; },
              false },
            { "residual", [](const StudyRow &row) { return row.statistics.residual; }, false },
            { "min det F", [](const StudyRow &row) { return row.statistics.min_det_F; }, false } });
      if (!has_reference)
        columns.insert(
            columns.end(),
            { { "energy growth", [](const StudyRow &row) { return row.statistics.energy_growth; },
                false },
              { "max displacement", [](const StudyRow &row) { return row.max_displacement; },
                false } });
      for (unsigned int i = 0; i < table.extra_columns.size(); ++i)
        columns.push_back(
            { table.extra_columns[i], [i](const StudyRow &row) { return row.extra[i]; }, false });
      return columns;
    }

    /// The axes whose values a table lists: the numeric one, or all.
    std::vector<unsigned int>
    listed_axes(const std::vector<StudyAxis> &axes)
    {
      if (const auto numeric = numeric_axis(axes))
        return { *numeric };
      std::vector<unsigned int> all(axes.size());
      for (unsigned int a = 0; a < axes.size(); ++a)
        all[a] = a;
      return all;
    }

    void
    write_table_head(std::ostream &out, const StudyTable &table, const std::vector<Column> &columns)
    {
      const bool  has_orders = numeric_axis(table.axes).has_value();
      std::string rule       = "|";
      const auto  write      = [&](const std::string &title, const char *alignment)
      {
        out << " " << cell(title) << " |";
        rule += alignment;
      };
      out << "|";
      for (const unsigned int a : listed_axes(table.axes))
        write(table.axes[a].name(), "---|");
      write("status", "---|");
      for (const Column &column : columns)
      {
        write(column.title, "---:|");
        if (column.has_order && has_orders)
          write("order", "---:|");
      }
      out << '\n' << rule << '\n';
    }

    void
    write_table(std::ostream &out, const StudyTable &table, const StudyLine &line)
    {
      const auto                numeric = numeric_axis(table.axes);
      const std::vector<Column> columns = columns_of(table);
      write_table_head(out, table, columns);
      const StudyRow *before = nullptr;
      for (const StudyRow *row : line.rows)
      {
        out << "|";
        for (const unsigned int a : listed_axes(table.axes))
          out << " " << cell(table.axes[a].text(row->choice[a])) << " |";
        out << " " << row->status << " |";
        for (const Column &column : columns)
        {
          out << " " << rounded(column.value(*row)) << " |";
          if (!column.has_order || !numeric)
            continue;
          const StudyAxis &axis = table.axes[*numeric];
          out << " "
              << (before == nullptr
                      ? ""
                      : rounded(observed_order(column.value(*before), column.value(*row),
                                               number_of(axis, before->choice[*numeric]),
                                               number_of(axis, row->choice[*numeric]))))
              << " |";
        }
        out << '\n';
        before = row;
      }
    }

    /// "Section/Key = value, ..." on all axes, or on those that are constant in a line.
    std::string
    values_text(const StudyTable &table, const StudyRow &row, const bool of_line)
    {
      const auto  numeric = numeric_axis(table.axes);
      std::string text;
      for (unsigned int a = 0; a < table.axes.size(); ++a)
        if (!of_line || (numeric && a != *numeric))
          text += (text.empty() ? "" : ", ") + table.axes[a].name() + " = "
                  + table.axes[a].text(row.choice[a]);
      return text;
    }

    /// List failures, grouped by their message.
    void
    write_failures(std::ostream &out, const StudyTable &table)
    {
      std::map<std::string, std::vector<const StudyRow *>> failures;
      for (const StudyRow &row : table.rows)
        if (row.exit_status != 0)
          failures[row.status + ". " + row.message].push_back(&row);
      if (!failures.empty())
        out << "\n## What failed\n";
      for (const auto &[reason, rows] : failures)
      {
        out << "\n" << rows.size() << (rows.size() == 1 ? " run: " : " runs: ") << reason << "\n\n";
        for (const StudyRow *row : rows)
          out << "- " << values_text(table, *row, false) << '\n';
      }
    }

    using Points = std::vector<std::pair<double, double>>;

    /// Seconds and errors of the rows that have both.
    Points
    points_of(const StudyLine &line)
    {
      Points points;
      for (const StudyRow *row : line.rows)
        if (row->seconds.median > 0. && row->errors.l2 > 0.) // logarithmic axes
          points.emplace_back(row->seconds.median, row->errors.l2);
      return points;
    }

    /// A string constant of gnuplot in single quotes, where only the quote is special.
    std::string
    quoted(const std::string &text)
    {
      std::string result = "'";
      for (const char c : text)
        result += c == '\'' ? "''" : std::string(1, c);
      return result + "'";
    }

    void
    write_data(std::ostream &out, const std::string &name, const Points &points)
    {
      out << '$' << name << " << EOD\n";
      for (const auto &[seconds, error] : points)
        out << shortest_text(seconds) << ' ' << shortest_text(error) << '\n';
      out << "EOD\n";
    }

    /// Colours that are distinguishable for the colour-blind and not faint on white; the same as in
    /// doc/scripts/plots.py.
    const std::array<const char *, 8> palette{ { "#0072b2", "#d55e00", "#009e73", "#aa4499",
                                                 "#e69f00", "#56b4e9", "#000000", "#777777" } };
    /// Numbers of gnuplot's disc, square, triangles up and down, diamond.
    const std::array<int, 5> marks{ { 7, 5, 9, 11, 13 } };

    /// The index of a value among those seen; new ones are appended.
    template <typename T>
    std::size_t
    place_of(const T &value, std::vector<T> &seen)
    {
      const auto found = std::find(seen.begin(), seen.end(), value);
      if (found == seen.end())
        seen.push_back(value);
      return std::find(seen.begin(), seen.end(), value) - seen.begin();
    }

    /// Styles of lines: the last axis sets the colour, the others together set dash and mark.
    class LineStyles
    {
    public:
      std::string
      operator()(std::vector<unsigned int> choice)
      {
        std::size_t colour = 0;
        if (!choice.empty())
        {
          colour = place_of(choice.back(), colours);
          choice.pop_back();
        }
        const std::size_t variant = place_of(choice, variants);
        return fmt::format("linespoints lw 2 dt {} pt {} ps 0.8 lc rgb '{}'", 1 + variant,
                           marks[variant % marks.size()], palette[colour % palette.size()]);
      }

    private:
      std::vector<unsigned int>              colours;
      std::vector<std::vector<unsigned int>> variants;
    };

    void
    write_script(std::ostream &out, const std::vector<StudyLine> &lines, const std::string &title)
    {
      out << "# Drawn by exemplar; to draw it anew: gnuplot study.gnuplot\n"
          << "set terminal svg noenhanced size 800,600 font 'sans-serif,15' background 'white'\n"
          << "set output 'study.svg'\n"
          << "set title " << quoted(title) << "\n"
          << "set logscale xy\nset format '%g'\nset grid\n"
          << "set key below center Left reverse samplen 3 height 1\n"
          << "set xlabel 'seconds of time stepping'\n"
          << "set ylabel 'position error at the end (L2, relative)'\n";
      Points      all;
      std::string plots;
      LineStyles  style;
      for (unsigned int l = 0; l < lines.size(); ++l)
        if (const Points points = points_of(lines[l]); !points.empty())
        {
          const std::string name = fmt::format("line{}", l);
          write_data(out, name, points);
          plots += (plots.empty() ? "" : ", \\\n  ") + ("$" + name) + " with "
                   + style(lines[l].choice) + " title "
                   + quoted(lines[l].title.empty() ? "error" : lines[l].title);
          all.insert(all.end(), points.begin(), points.end());
        }
      write_data(out, "front", pareto_front(all));
      out << "plot " << plots
          << ", \\\n  $front with points pt 6 ps 1.8 lw 2 lc 'black' title 'Pareto front'\n";
    }
  } // namespace

  void
  write_study_report(const Study &study, const StudyTable &table, const std::filesystem::path &file)
  {
    AtomicFile    atomic_file(file);
    std::ostream &out = atomic_file.stream();
    write_head(out, study);
    if (table.has_reference)
      out << "\nErrors are those at the end, over the displacement and the energy of the "
             "reference.\nAn order is p in error ~ number^p, between a row and the one above.\n";
    for (const StudyLine &line : lines_of(table))
    {
      if (const std::string title = values_text(table, *line.rows[0], true); !title.empty())
        out << "\n## " << title << "\n";
      out << '\n';
      write_table(out, table, line);
    }
    write_failures(out, table);
    atomic_file.commit();
  }

  std::vector<std::pair<double, double>>
  pareto_front(std::vector<std::pair<double, double>> points)
  {
    std::sort(points.begin(), points.end());
    Points front;
    for (const auto &point : points)
      if (front.empty() || point.second < front.back().second)
        front.push_back(point);
    return front;
  }

  std::string
  plot_study(const StudyTable &table, const std::string &title, const StudyDirectory &directory)
  {
    const std::vector<StudyLine> lines = lines_of(table);
    if (std::all_of(lines.begin(), lines.end(),
                    [](const StudyLine &line) { return points_of(line).empty(); }))
      return "";
    {
      AtomicFile script(directory.gnuplot());
      write_script(script.stream(), lines, title);
      script.commit();
    }
    const std::filesystem::path    log = directory.runs() / "gnuplot.log";
    const std::vector<std::string> command
        = { "gnuplot", "-e", "cd " + quoted(directory.get_path()), directory.gnuplot().filename() };
    const ChildEnd end = run_child(command, log, 60.);
    if (end.exit_status == no_such_program)
      return "There is no gnuplot, so " + directory.svg().string()
             + " is not drawn. Install it (Debian: apt-get install gnuplot-nox) and call the study "
               "again; what has been run is not run anew.";
    if (end.exit_status != 0)
      return "gnuplot could not draw " + directory.svg().string() + "; what it says is in "
             + log.string() + ".";
    std::filesystem::remove(log);
    return "";
  }
} // namespace Exemplar
