// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/prm/assignments.h>
#include <exemplar/prm/expression.h>

#include <muParser.h>

#include <array>
#include <cmath>
#include <regex>

namespace Exemplar
{
  namespace
  {
    // muParser differs between versions in what `log` means
    double
    natural_logarithm(const double x)
    {
      return std::log(x);
    }

    /// muParser would take "t = 1" for an assignment to t.
    void
    check_no_assignment(const std::string &key, const std::string &text)
    {
      static const std::regex comparison("[=<>!]=");
      if (std::regex_replace(text, comparison, "").find('=') != std::string::npos)
        throw UserError(key + ": the formula '" + text
                        + "' holds a single '='. Write == to compare.");
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

  struct Expression::Parsers
  {
    std::string              key;
    std::vector<std::string> texts;
    std::array<double, 4>    variables{}; // x, y, z, t, as the parsers see them
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
    parsers->texts = split_trimmed(text, ';');
    if (parsers->texts.size() != n_components)
      throw UserError(key + " = '" + text + "' has " + std::to_string(parsers->texts.size())
                      + " formulas, but needs " + std::to_string(n_components)
                      + ", separated by ';'.");
    parsers->parsers.resize(n_components);
    for (unsigned int i = 0; i < n_components; ++i)
    {
      mu::Parser &parser = parsers->parsers[i];
      check_no_assignment(key, parsers->texts[i]);
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
        throw UserError(key + ": the formula '" + parsers->texts[i] + "' is not understood: "
                        + error.GetMsg() + " Allowed are the variables " + names
                        + ", the constant pi, + - * / ^, c ? a : b, and muParser's "
                          "functions (sin, cos, sqrt, exp, log, min, max, ...).");
      }
    }
  }

  std::vector<double>
  Expression::values(const dealii::Point<3> &position, const double time) const
  {
    parsers->variables = { { position[0], position[1], position[2], time } };
    std::vector<double> values;
    for (unsigned int i = 0; i < parsers->parsers.size(); ++i)
    {
      values.push_back(parsers->parsers[i].Eval());
      if (!std::isfinite(values.back()))
        throw SolverFailure(parsers->key + ": the formula '" + parsers->texts[i]
                            + "' is not finite at t = " + shortest_text(time) + ", position ("
                            + shortest_text(position[0]) + ", " + shortest_text(position[1]) + ", "
                            + shortest_text(position[2])
                            + "). Change it, for instance with max() or c ? a : b.");
    }
    return values;
  }

  dealii::Tensor<1, 3>
  Expression::vector(const dealii::Point<3> &position, const double time) const
  {
    const std::vector<double> components = values(position, time);
    return dealii::Tensor<1, 3>({ components.at(0), components.at(1), components.at(2) });
  }
} // namespace Exemplar
