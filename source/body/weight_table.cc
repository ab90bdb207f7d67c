// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/csv_file.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/missing_file.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/time_samples.h>
#include <exemplar/body/weight_table.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Exemplar
{
  namespace
  {
    /// A sum that differs from one by no more is one in the digits that programs write.
    constexpr double rounding_of_sums = 1e-5;

    /// Reads the lines of a table of weights.
    class WeightTableReader
    {
    public:
      WeightTableReader(const std::filesystem::path &file, const ExampleParameters &examples)
          : name(file.string()), n_examples(examples.n_examples()),
            n_strained(n_examples - (examples.has_rest_pose() ? 1 : 0))
      {
        for (const std::string &pose : examples.poses)
          stems.push_back(std::filesystem::path(pose).stem().string());
        require_file(file, "a table of weights in CSV, with the columns t and one per example");
        for (const CsvLine &line : read_csv_file(file, "table of weights"))
          read(line);
        if (table.empty())
          throw UserError(
              name
              + " has no weights. Write a line of t and one weight per example for each time.");
      }

      WeightTable table;

    private:
      [[noreturn]] void
      fail(const CsvLine &line, const std::string &fault) const
      {
        throw UserError(fmt::format("{}, line {}: {}", name, line.number, fault));
      }

      void
      read(const CsvLine &line)
      {
        const bool is_first = n_columns == 0;
        if (is_first)
        {
          check_width(line);
          n_columns = line.cells.size();
          if (!std::all_of(line.cells.begin(), line.cells.end(), is_number))
          {
            check_names(line);
            return;
          }
        }
        if (line.cells.size() != n_columns)
          fail(line,
               fmt::format("it has {} cells, but the first line has {}. Write t and one weight per "
                           "example in each line.",
                           line.cells.size(), n_columns));
        add(line);
      }

      void
      check_width(const CsvLine &line) const
      {
        const std::size_t n = line.cells.size() - 1;
        if (n == n_examples || n == n_strained)
          return;
        const std::string wanted
            = n_strained == n_examples
                  ? fmt::format("{} after t", n_examples)
                  : fmt::format("{} after t, or {} with the rest pose as the first one", n_strained,
                                n_examples);
        fail(line,
             fmt::format(
                 "it has {} {} of weights, but there must be one per example, in the order of "
                 "Examples/Poses and then of Examples/Pose functions: {}.",
                 n, n == 1 ? "column" : "columns", wanted));
      }

      /// Names need not be those of the poses' files, but a name of another pose's file is a column in the wrong place.
      void
      check_names(const CsvLine &line) const
      {
        std::string first = line.cells[0].substr(0, line.cells[0].find_first_of(" [("));
        std::transform(first.begin(), first.end(), first.begin(),
                       [](const unsigned char c) { return static_cast<char>(std::tolower(c)); });
        if (first != "t" && first != "time")
          fail(line,
               "the first column is " + in_quotes(line.cells[0])
                   + ", but must be 't', the time of the scene. Divide numbers of frames by the "
                     "frames per second.");
        const std::size_t before
            = n_columns - n_strained; // columns before those of strained examples
        for (std::size_t column = before; column < n_columns; ++column)
        {
          const auto found = std::find(stems.begin(), stems.end(), line.cells[column]);
          if (found != stems.end() && found - stems.begin() != std::ptrdiff_t(column - before)
              && std::count(stems.begin(), stems.end(), line.cells[column]) == 1)
            fail(line, fmt::format(
                           "column {} is named {}, but has the weights of {}. Write the columns in "
                           "the order of Examples/Poses and then of Examples/Pose functions.",
                           column + 1, in_quotes(line.cells[column]),
                           column - before < stems.size() ? in_quotes(stems[column - before])
                                                          : "a pose function"));
        }
      }

      void
      add(const CsvLine &line)
      {
        std::vector<double> numbers;
        for (const std::string &cell : line.cells)
        {
          numbers.push_back(parse_number(cell));
          if (!std::isfinite(numbers.back()))
            fail(line, in_quotes(cell) + " is not a finite number.");
        }
        if (!table.empty() && !(numbers[0] > table.times.back()))
          fail(line,
               fmt::format(
                   "t = {} is not later than t = {} in the line before. Sort the lines by t; for "
                   "a jump, write two times that are close to each other.",
                   line.cells[0], shortest_text(table.times.back())));
        table.times.push_back(numbers[0]);
        numbers.erase(numbers.begin());
        table.weights.push_back(complete(std::move(numbers), line));
      }

      /// The weights of all examples, with the sum one.
      std::vector<double>
      complete(std::vector<double> weights, const CsvLine &line) const
      {
        const double sum = std::accumulate(weights.begin(), weights.end(), 0.);
        if (weights.size() < n_examples)
          weights.insert(weights.begin(), 1. - sum);
        else if (!(std::abs(sum - 1.) < rounding_of_sums))
          fail(line,
               fmt::format("the weights sum to {}, not to 1. {}", short_text(sum),
                           n_strained < n_examples
                               ? "Leave the column of the rest pose out: its weight is then 1 "
                                 "minus the others."
                               : "Make one of them 1 minus the others, or include the rest pose "
                                 "(Examples/Include rest pose = true), whose weight is 1 minus the "
                                 "others."));
        else
          for (double &weight : weights)
            weight /= sum;
        return weights;
      }

      const std::string        name;
      const std::size_t        n_examples, n_strained;
      std::vector<std::string> stems; ///< of the poses' files
      std::size_t              n_columns = 0;
    };
  } // namespace

  std::vector<double>
  WeightTable::at(const double time) const
  {
    const auto [before, next, share] = samples_around(times, time);
    std::vector<double> result       = weights[before];
    for (std::size_t i = 0; i < result.size() && share > 0.; ++i)
      result[i] += share * (weights[next][i] - result[i]);
    return result;
  }

  WeightTable
  read_weight_table(const std::filesystem::path &file, const ExampleParameters &examples)
  {
    return WeightTableReader(file, examples).table;
  }
} // namespace Exemplar
