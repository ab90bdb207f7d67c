// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_expression_h
#define exemplar_expression_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <memory>
#include <string>
#include <vector>

namespace Exemplar
{
  /// The formulas of a text, which ';' separates, or commas outside of parentheses if these make `n_components` of
  /// several.
  std::vector<std::string>
  split_formulas(const std::string &text, unsigned int n_components);

  /// Formulas of a scene file, separated by ';', or by commas outside of parentheses, evaluated by muParser.
  class Expression
  {
  public:
    /// `key` names the formulas in messages, `variables` is a subset of "xyzt". Throws UserError,
    /// with the formula and a remedy, if there are not `n_components` formulas, or if muParser
    /// cannot parse one.
    Expression(const std::string &key,
               const std::string &text,
               const std::string &variables,
               unsigned int       n_components);

    ~Expression();
    Expression(Expression &&) noexcept;
    Expression &
    operator=(Expression &&) noexcept;

    /// Values at (x, y, z) and t [s]. Throws SolverFailure if one is not finite.
    std::vector<double>
    values(const dealii::Point<3> &position, double time) const;

    /// The value of the first formula there. Throws as values().
    double
    value(const dealii::Point<3> &position, double time) const;

    /// Values of three components at (x, y, z) and t [s]. Throws as values().
    dealii::Tensor<1, 3>
    vector(const dealii::Point<3> &position, double time) const;

  private:
    /// The value of formula i.
    double
    component(unsigned int i, const dealii::Point<3> &position, double time) const;

    struct Parsers;
    std::unique_ptr<Parsers> parsers;
  };
} // namespace Exemplar

#endif
