// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/expression.h>

#include <fmt/core.h>
#include <muParser.h>

#include <array>
#include <cmath>
#include <regex>
#include <utility>

namespace Exemplar
{
  namespace
  {
    // muParser's versions differ in the base of `log`
    double
    natural_logarithm(const double x)
    {
      return std::log(x);
    }

    /// Throws UserError for "t = 1", which muParser would parse as an assignment to t.
    void
    check_no_assignment(const std::string &key, const std::string &text)
    {
      static const std::regex comparison("[=<>!]=");
      if (std::regex_replace(text, comparison, "").find('=') != std::string::npos)
        throw UserError(key + ": the formula '" + text
                        + "' holds a single '='. Write == to compare.");
    }

    /// The text with ';' for each comma outside all parentheses, where it separates no arguments.
    std::string
    with_semicolons(std::string text)
    {
      int depth = 0;
      for (char &c : text)
      {
        depth += c == '(' ? 1 : c == ')' ? -1 : 0;
        if (c == ',' && depth == 0)
          c = ';';
      }
      return text;
    }

    /// Whether there is such a comma.
    bool
    has_outer_comma(const std::string &text)
    {
      return with_semicolons(text) != text;
    }

    /// Throws UserError for such a comma: muParser would drop the text before it.
    void
    check_no_outer_comma(const std::string &key, const std::string &text)
    {
      if (has_outer_comma(text))
        throw UserError(key + ": the formula '" + text
                        + "' holds a comma. The decimal sign is a point, as in 0.5, and formulas "
                          "are separated by ';'.");
    }

    /// Remedy for a wrong number of formulas.
    std::string
    remedy_of_number(const std::vector<std::string> &texts,
                     const unsigned int              n_components,
                     const bool                      are_of_places)
    {
      if (texts.empty())
        return " Is there a ';' or '|' too many?";
      if (texts.size() == n_components + 1 && texts.back().empty())
        return " Remove the ';' at the end.";
      if (texts.size() == 1 && has_outer_comma(texts[0]))
        return " The decimal sign is a point, as in 0.5.";
      if (texts.size() == 1 && n_components > 1)
        return std::string(are_of_places ? " They are for x, y and z; write 0 where nothing is."
                                         : "")
               + " On a command line the whole needs quotes, as a shell ends its commands at ';'.";
      if (are_of_places && texts.size() > n_components && texts.size() % n_components == 0)
        return " If they are of several poses, separate these by '|': x; y; z | x; y; z.";
      if (texts.size() < n_components && are_of_places)
        return " They are for x, y and z; write 0 where nothing is.";
      return "";
    }

    /// Remedy for a formula in the syntax of other languages.
    std::string
    remedy_of_formula(const std::string &text)
    {
      const std::vector<std::pair<std::string, std::string>> habits = {
        { "\\*\\*", "Powers are written x^2." },
        { "\\b(np|numpy|math|std|Math)\\b", "Functions have no prefix: sin(t)." },
        { "\\bdeg(rees?)?\\b|\xC2\xB0", "Angles are in radians: 90 degrees are 90*pi/180." },
        { "\\b(heaviside|Heaviside|step) *\\(", "A step is written t > 0.5 ? 1 : 0." },
        { "[0-9.] *(m|cm|mm|s|ms|N|kN|kg|Pa)\\b",
          "Numbers have no unit: lengths are in m, times in s, forces in N." },
        { "(^|[^a-zA-Z0-9_.])[0-9.]+ *(?![eE][-+0-9])[a-zA-Z(]", "Products are written 2*t." },
        { "\\bif *\\(", "A choice is written c ? a : b." },
        { "\\bPI\\b|\\bPi\\b|M_PI|\xCF\x80", "The constant is written pi." },
        { "\\btime\\b|\\bT\\b", "The time is t." },
        { "\\b[XYZ]\\b", "Coordinates are x, y, z, in small letters." },
        { "\\b(mod|fmod)\\b|%", "t modulo 1 is t - floor(t)." },
        { "^[\\[({][^\\])}]*$|^[^\\[({]*[\\])}]$", "No brackets stand around the formulas." },
        { "\xE2\x88\x92|\xE2\x80\x93", "The sign of minus is -, not a dash." },
        { "\xC2\xB2|\xC2\xB3", "Powers are written x^2." },
        { "\xC2\xB7|\xC3\x97", "The sign of products is *." },
        { "^$", "Write 0 where nothing is, and $ in single quotes where a shell reads it." }
      };
      if (text.size() < 200)
        for (const auto &[pattern, remedy] : habits)
          if (std::regex_search(text, std::regex(pattern)))
            return " " + remedy;
      return "";
    }

    /// Place of an empty formula among several, for messages; empty for other formulas.
    std::string
    place_among(const unsigned int i, const std::string &all, const unsigned int n)
    {
      if (n == 1 || !split_formulas(all, n)[i].empty())
        return "";
      return fmt::format(", number {} of '{}',", i + 1, all);
    }

    double
    floor(const double x)
    {
      return std::floor(x);
    }

    double
    ceil(const double x)
    {
      return std::ceil(x);
    }
  } // namespace

  std::vector<std::string>
  split_formulas(const std::string &text, const unsigned int n_components)
  {
    std::vector<std::string> by_semicolons = split_trimmed(text, ';');
    if (by_semicolons.size() == 1 && n_components > 1)
      if (std::vector<std::string> by_commas = split_trimmed(with_semicolons(text), ';');
          by_commas.size() == n_components)
        return by_commas;
    return by_semicolons;
  }

  struct Expression::Parsers
  {
    std::string              key;
    std::vector<std::string> texts;
    std::array<double, 4>    variables{}; // x, y, z, t, as bound to the parsers
    std::vector<mu::Parser>  parsers;
  };

  Expression::~Expression()                      = default;
  Expression::Expression(Expression &&) noexcept = default;
  Expression &
  Expression::operator=(Expression &&) noexcept = default;

  Expression::Expression(const std::string &key,
                         const std::string &text,
                         const std::string &variables,
                         const unsigned int n_components)
      : parsers(std::make_unique<Parsers>())
  {
    parsers->key   = key;
    parsers->texts = split_formulas(text, n_components);
    if (parsers->texts.size() != n_components)
      throw UserError(fmt::format(
          "{} = '{}' has {}{}{}, separated by ';'.{}", key, text, parsers->texts.size(),
          parsers->texts.size() == 1 ? " formula, but needs " : " formulas, but needs ",
          n_components, remedy_of_number(parsers->texts, n_components, variables != "t")));
    parsers->parsers.resize(n_components);
    for (unsigned int i = 0; i < n_components; ++i)
    {
      mu::Parser &parser = parsers->parsers[i];
      check_no_assignment(key, parsers->texts[i]);
      check_no_outer_comma(key, parsers->texts[i]);
      parser.DefineConst("pi", 3.14159265358979323846);
      parser.DefineFun("log", natural_logarithm);
      parser.DefineFun("floor", floor);
      parser.DefineFun("ceil", ceil);
      for (const char variable : variables)
        parser.DefineVar(std::string(1, variable),
                         &parsers->variables[std::string("xyzt").find(variable)]);
      try
      {
        parser.SetExpr(parsers->texts[i]);
        parser.Eval();
      }
      catch (const mu::Parser::exception_type &error)
      {
        std::string names;
        for (const char variable : variables)
          names += std::string(names.empty() ? "" : ", ") + variable;
        throw UserError(
            key + ": the formula '" + parsers->texts[i] + "'" + place_among(i, text, n_components)
            + " is not understood: " + std::regex_replace(error.GetMsg(), std::regex("[. ]*$"), "")
            + "." + remedy_of_formula(parsers->texts[i])
            + (variables.size() == 1 ? " Allowed: the variable " : " Allowed: the variables ")
            + names
            + ", the constant pi, + - * / ^, c ? a : b, and muParser's functions (sin, cos, "
              "sqrt, exp, log, min, max, ...).");
      }
    }
  }

  double
  Expression::component(const unsigned int      i,
                        const dealii::Point<3> &position,
                        const double            time) const
  {
    parsers->variables = { { position[0], position[1], position[2], time } };
    const double value = parsers->parsers[i].Eval();
    if (!std::isfinite(value))
      throw SolverFailure(parsers->key + ": the formula '" + parsers->texts[i]
                          + "' is not finite at t = " + shortest_text(time) + ", position ("
                          + shortest_text(position[0]) + ", " + shortest_text(position[1]) + ", "
                          + shortest_text(position[2])
                          + "). Change it, for instance with max() or c ? a : b.");
    return value;
  }

  std::vector<double>
  Expression::values(const dealii::Point<3> &position, const double time) const
  {
    std::vector<double> values(parsers->parsers.size());
    for (unsigned int i = 0; i < values.size(); ++i)
      values[i] = component(i, position, time);
    return values;
  }

  double
  Expression::value(const dealii::Point<3> &position, const double time) const
  {
    return component(0, position, time);
  }

  dealii::Tensor<1, 3>
  Expression::vector(const dealii::Point<3> &position, const double time) const
  {
    dealii::Tensor<1, 3> components;
    for (unsigned int i = 0; i < 3; ++i)
      components[i] = component(i, position, time);
    return components;
  }
} // namespace Exemplar
