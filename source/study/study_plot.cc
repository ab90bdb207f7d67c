// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/child_process.h>
#include <exemplar/base/number_text.h>
#include <exemplar/study/study_plot.h>

#include <fmt/core.h>

#include <algorithm>
#include <array>

namespace Exemplar
{
  namespace
  {
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
