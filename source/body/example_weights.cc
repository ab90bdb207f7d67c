// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/conditioning.h>
#include <exemplar/algebra/dense.h>
#include <exemplar/algebra/long_vectors.h>
#include <exemplar/algebra/weight_qp.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/dependent_poses.h>
#include <exemplar/body/example_weights.h>
#include <exemplar/prm/assignments.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <sstream>

namespace Exemplar
{
  double
  blended_part(const ExampleEnergy energy)
  {
    if (energy == ExampleEnergy::mixed)
      return 0.2;
    return energy == ExampleEnergy::blended ? 1. : 0.;
  }

  namespace
  {
    /// A weight nearer to its upper bound than this differs from it by rounding alone.
    constexpr double rounding_of_weights = 1e-14;

    /// The parts of the ridge in regions that were found; empty without. Many examples strain a region little or
    /// not at all, so that their weights make no difference there, and take part in what is next to it. So the ridge
    /// is a ten-thousandth of what the example that strains the region most costs, and rest has hardly any: it is what
    /// remains. Regions stay as they were found while poses change, and so does this.
    std::vector<double>
    parts_in_found_regions(const ExampleParameters &parameters, const ExampleTargets &targets)
    {
      constexpr double part_of_rest = 1e-3, part_of_strains = 1e5; // times 1e-9 sum E V
      if (!parameters.finds_regions() || targets.n_regions() == 1 || !parameters.are_bounded())
        return {};
      const std::vector<double> measures = targets.measures_of_weights();
      std::vector<double>       parts;
      for (unsigned int region = 0; region < targets.n_regions(); ++region)
      {
        double most = 0.; // mean square of strains
        for (unsigned int i = 0; i < targets.size(); ++i)
        {
          const unsigned int weight = region * targets.size() + i;
          most = std::max(most, std::pow(targets.norms()[weight] / parameters.importance, 2)
                                    / measures[weight]);
        }
        for (unsigned int i = 0; i < targets.size(); ++i)
          parts.push_back(i == 0 && parameters.has_rest_pose() ? part_of_rest
                                                               : 1. + part_of_strains * most);
      }
      return parts;
    }

    std::string
    names_of_examples(const ExampleTargets &targets)
    {
      std::string names;
      for (unsigned int example = 0; example < targets.size(); ++example)
        names += (example == 0 ? "" : " | ") + targets.name(example);
      return names;
    }

    WeightMemory
    make_memory(const ExampleParameters &parameters, const ExampleTargets &targets)
    {
      const auto per_weight = [&targets](const double density)
      {
        std::vector<double> values;
        if (density > 0.)
          for (const double volume : targets.measures_of_weights())
            values.push_back(density * volume);
        return values;
      };
      return { per_weight(parameters.yield), per_weight(parameters.creep_viscosity) };
    }
  } // namespace

  ExampleWeights::ExampleWeights(const ExampleParameters &parameters,
                                 const ExampleTargets    &targets,
                                 const double             unit_energy,
                                 const TimeAxis          &axis,
                                 WeightTable              of_file)
      : targets(targets), bounded(parameters.are_bounded()),
        additive(parameters.weights == WeightRule::additive),
        parts_of_ridge(parts_in_found_regions(parameters, targets)),
        memory(make_memory(parameters, targets))
  {
    if (parameters.weights == WeightRule::prescribed && size() > 0)
    {
      table = std::move(of_file);
      if (table.empty())
        read_prescribed(parameters.prescribed_weights);
      for (unsigned int step = 0; step <= axis.n_steps(); ++step)
        check_sums(axis.time(step));
    }
    set_parameters(parameters, unit_energy);
  }

  void
  ExampleWeights::set_parameters(const ExampleParameters &parameters, const double unit_energy)
  {
    if (are_prescribed() || size() == 0)
      return;
    warnings.clear();
    find_preferences(unit_energy);
    compute_form(parameters, unit_energy);
    check_independence(unit_energy, parameters.ridge(unit_energy) > 0.);
  }

  void
  ExampleWeights::check_held(const std::vector<double> &values) const
  {
    if (!bounded || size() == 0)
      throw UserError("Only weights of Examples/Weights = simplex or additive can be held.");
    if (!values.empty() && values.size() != size())
      throw UserError(
          fmt::format("{} weights are given, but there are {}.", values.size(), size()));
    if (additive)
    {
      for (const double value : values)
        if (!(value >= 0. && value <= 1.))
          throw UserError("Weights that are held must be between 0 and 1; one is "
                          + shortest_text(value) + ".");
      return;
    }
    for (auto region = values.begin(); region != values.end(); region += n_per_region())
    {
      const double sum   = std::accumulate(region, region + n_per_region(), 0.);
      const double least = *std::min_element(region, region + n_per_region());
      if (!(least >= 0.) || !(std::abs(sum - 1.) < 1e-6))
        throw UserError(
            fmt::format("Weights that are held must not be negative and sum to 1; the least is {}, "
                        "and the sum {}.",
                        shortest_text(least), shortest_text(sum)));
    }
  }

  void
  ExampleWeights::hold(std::vector<double> values)
  {
    check_held(values);
    for (auto region = values.begin(); !additive && region != values.end();
         region += n_per_region())
    {
      const double sum = std::accumulate(region, region + n_per_region(), 0.);
      std::for_each(region, region + n_per_region(), [sum](double &weight) { weight /= sum; });
    }
    held = std::move(values);
  }

  void
  ExampleWeights::compute_form(const ExampleParameters &parameters, const double unit_energy)
  {
    const unsigned int n = targets.n_weights();
    penalty.reinit(n, n);
    form.coupled.clear();
    form.N.reinit(additive ? 0 : n_regions(), n);
    const double sigma = parameters.ridge(unit_energy);
    // the ridge is scaled by volume fractions, so that equal weights in all regions cost as much as
    // global ones
    const std::vector<double> &fraction = targets.fractions();
    for (unsigned int weight = 0; weight < n; ++weight)
      penalty(weight, weight) = sigma * fraction[weight / targets.size()] * part_of_ridge(weight);
    if (parameters.energy != ExampleEnergy::scaled)
      targets.add_blended(blended_part(parameters.energy), penalty);
    add_preferences(unit_energy);
    form.H = penalty;
    form.H.add(1., targets.gram());
    for (unsigned int weight = 0; weight < n; ++weight)
    {
      if (!additive)
        form.N(weight / targets.size(), weight) = 1.;
      if (targets.is_strained(weight))
        form.coupled.push_back(weight);
    }
  }

  void
  ExampleWeights::find_preferences(const double unit_energy)
  {
    preference_form.reinit(0, 0);
    if (!bounded || !(unit_energy > 0.))
      return;
    const bool has_rest = additive || targets.first_strained() > 0;
    const auto found    = find_dependent_poses(targets, has_rest);
    preference_form     = preference_of(found, targets, has_rest, unit_energy);
    for (const DependentPoses &poses : found)
      warnings.push_back(describe(poses, targets, has_rest));
  }

  void
  ExampleWeights::add_preferences(const double unit_energy)
  {
    form.convexity.assign(preference_form.m(), 0.);
    for (unsigned int v = 0; v < preference_form.m(); ++v)
      for (unsigned int w = 0; w < preference_form.n(); ++w)
      {
        const double entry
            = unit_energy * targets.fractions()[v / targets.size()] * preference_form(v, w);
        penalty(v, w) += entry;
        if (v != w)
          form.convexity[v] += std::max(entry, 0.);
      }
  }

  void
  ExampleWeights::set_step(WeightStep step)
  {
    memory.set_step(std::move(step));
    for (unsigned int weight = 0; memory.creeps() && weight < form.H.m(); ++weight)
      form.H(weight, weight)
          = penalty(weight, weight) + targets.gram()(weight, weight) + memory.stiffness(weight);
  }

  void
  ExampleWeights::read_prescribed(const std::string &text)
  {
    const std::string              key            = "Examples/Prescribed weights";
    const std::vector<std::string> lists          = split_trimmed(text, '|');
    const unsigned int             n_regions      = targets.n_regions();
    const bool                     are_per_region = targets.region_id(0).has_value();
    if (lists.size() != 1 && lists.size() != n_regions)
      throw UserError(fmt::format("{} has {} lists separated by |, but {} Give one list for all{}",
                                  key, lists.size(),
                                  are_per_region ? fmt::format("there are {} regions.", n_regions)
                                                 : "all cells have the same weights "
                                                   "(Examples/Weights per region is false).",
                                  are_per_region ? " or one for each region." : "."));
    for (const std::string &list : lists)
    {
      if (const std::size_t n = split_trimmed(list, ';').size(); n < targets.size())
        throw UserError(
            fmt::format("{} = '{}' has {} {} for {} examples: example {} ({}) lacks one. "
                        "Write one for each, separated by ';', not by commas. The examples are {}.",
                        key, list, n, n == 1 ? "weight" : "weights", targets.size(), n,
                        targets.name(n), names_of_examples(targets)));
      else if (n > targets.size())
        throw UserError(fmt::format(
            "{} = '{}' has {} weights, but there {} only: {}. Write one for each; "
            "Examples/Include rest pose = true adds the rest pose, which is the first.",
            key, list, n,
            targets.size() == 1 ? "is one example" : fmt::format("are {} examples", targets.size()),
            names_of_examples(targets)));
      prescribed.emplace_back(key, list, "t", targets.size());
    }
    formulas = lists;
  }

  std::string
  ExampleWeights::remedy_for_sum(const std::string &list) const
  {
    std::vector<std::string> terms    = split_trimmed(list, ';');
    const bool               has_rest = targets.first_strained() > 0;
    terms.erase(has_rest ? terms.begin() : terms.end() - 1);
    return fmt::format("Make the {} 1 minus the others: 1 - ({})",
                       has_rest ? "first one, that of the rest pose," : "last one",
                       joined(terms, ") - ("));
  }

  void
  ExampleWeights::check_sums(const double time) const
  {
    for (unsigned int list = 0; list < prescribed.size(); ++list)
    {
      const auto   values = prescribed[list].values(dealii::Point<3>(), time);
      const double sum    = std::accumulate(values.begin(), values.end(), 0.);
      if (std::abs(sum - 1.) > 1e-10)
        throw UserError(fmt::format(
            "Examples/Prescribed weights = '{}' sum to {} at t = {}, not to 1. {}.", formulas[list],
            shortest_text(sum), shortest_text(time), remedy_for_sum(formulas[list])));
    }
  }

  std::vector<double>
  ExampleWeights::at(const double time) const
  {
    std::vector<double> all;
    for (unsigned int region = 0; region < n_regions(); ++region)
    {
      const auto values
          = table.empty()
                ? prescribed[prescribed.size() == 1 ? 0 : region].values(dealii::Point<3>(), time)
                : table.at(time);
      all.insert(all.end(), values.begin(), values.end());
    }
    return all;
  }

  std::vector<double>
  ExampleWeights::initial() const
  {
    std::vector<double> first(size(), 0.);
    for (unsigned int weight = 0; !additive && weight < size(); weight += n_per_region())
      first[weight] = 1.;
    return at(0., first);
  }

  std::vector<double>
  ExampleWeights::best(const std::vector<double> &c, const std::vector<double> &start) const
  {
    if (!held.empty())
      return held;
    const std::vector<double> sums(form.N.m(), 1.);
    WeightLimits              limits(std::vector<double>(bounded ? size() : 0, 0.));
    limits.upper.assign(additive ? size() : 0, 1.);
    memory.add_to(limits);
    const WeightQpSolution minimum = minimize_over_weights(form.H, c, sums, limits, start);
    if (!minimum.found)
      throw SolverFailure("The example weights are not determined. Set Examples/Weight penalty "
                          "to auto.");
    return minimum.weights;
  }

  WeightLimits
  ExampleWeights::limits_of_changes(const std::vector<double> &weights) const
  {
    WeightLimits limits;
    for (std::size_t i = 0; bounded && i < weights.size(); ++i)
      limits.lower.push_back((held.empty() ? 0. : held[i]) - weights[i]);
    for (std::size_t i = 0; additive && i < weights.size(); ++i)
      limits.upper.push_back((held.empty() ? 1. : held[i]) - weights[i]);
    if (held.empty()) // with held weights kinks may lie below the bounds
      memory.add_to(limits, weights);
    return limits;
  }

  std::vector<double>
  ExampleWeights::missing_sums(const std::vector<double> &weights) const
  {
    std::vector<double> missing;
    auto                first = weights.begin();
    for (unsigned int region = 0; region < form.N.m(); ++region, first += n_per_region())
      missing.push_back(1. - std::accumulate(first, first + n_per_region(), 0.));
    return missing;
  }

  void
  ExampleWeights::add(const std::vector<double> &changes, std::vector<double> &weights) const
  {
    for (std::size_t i = 0; i < changes.size(); ++i)
      weights[i] += changes[i];
    if (bounded)
      for (double &weight : weights)
        weight = std::max(weight, 0.);
    if (additive)
      for (double &weight : weights)
        weight = weight >= 1. - rounding_of_weights ? 1. : weight;
    memory.snap(weights);
  }

  std::size_t
  ExampleWeights::memory_consumption() const
  {
    return form.H.memory_consumption() + form.N.memory_consumption() + penalty.memory_consumption();
  }

  dealii::FullMatrix<double>
  ExampleWeights::form_of_changes(const dealii::FullMatrix<double> &all) const
  {
    return additive ? all : form_of_differences(all, n_per_region());
  }

  // Affinely dependent examples, whose weights are not unique.

  namespace
  {
    /// Conditioning of the Gram matrix, as a clause after "which".
    std::string
    condition_of(const dealii::FullMatrix<double> &gram, const double min_pivot)
    {
      if (!(min_pivot > 0.))
        return "is singular";
      std::ostringstream text;
      text << "has the condition number " << condition_number(gram);
      return text.str();
    }
  } // namespace

  namespace
  {
    /// The form of weights that are the same in all regions.
    dealii::FullMatrix<double>
    of_whole_body(const dealii::FullMatrix<double> &form, const unsigned int n_examples)
    {
      dealii::FullMatrix<double> sum(n_examples, n_examples);
      for (unsigned int v = 0; v < form.m(); ++v)
        for (unsigned int w = 0; w < form.n(); ++w)
          sum(v % n_examples, w % n_examples) += form(v, w);
      return sum;
    }
  } // namespace

  void
  ExampleWeights::check_independence(const double unit_energy, const bool has_ridge)
  {
    const unsigned int k = n_per_region();
    // in regions that were found many examples have no strain, which the ridge expects
    const bool are_found = !parts_of_ridge.empty() && has_ridge;
    // a key may have nothing to do with a region, where the ridge keeps its weight at 0
    const bool may_be_elsewhere = additive && has_ridge && n_regions() > 1;
    // strains of 1e-10 are rounding errors of a rest pose
    const double of_rounding = std::pow(1e-10 * targets.importance(), 2) * unit_energy;
    const dealii::FullMatrix<double> all
        = form_of_changes(are_found ? of_whole_body(targets.gram(), k) : targets.gram());
    std::vector<unsigned int> rows;
    for (unsigned int d = 0; d < all.m(); ++d)
      if (!may_be_elsewhere || all(d, d) > of_rounding)
        rows.push_back(d);
    if (rows.empty())
      return;
    dealii::FullMatrix<double> differences(rows.size(), rows.size());
    differences.extract_submatrix_from(all, rows, rows);
    const auto second = [&](const unsigned int row)
    { return additive ? rows[row] : rows[row] + rows[row] / (k - 1) + 1; };
    const MinPivot least = min_pivot(differences, of_rounding);
    if (differences.m() == 0 || least.ratio > 1e-8)
      return;
    if (has_ridge && !preference_form.empty())
      return; // of which there is a warning
    const unsigned int example = second(least.row) % k;
    const auto         region  = targets.region_id(second(least.row) / k);
    const std::string  where   = region && !are_found ? fmt::format(" in region {}", *region) : "";
    const std::string  which
        = fmt::format("Example {} ({}){}", targets.number(example), targets.name(example), where);
    const std::string combination = additive ? "a sum of multiples of the keys before it"
                                             : "an affine combination of the examples before it";
    if (least.ratio < 1e-12 && !has_ridge)
      throw UserError(which + " is " + combination
                      + ", so their weights "
                        "are not determined. Remove it from Examples/Poses or Examples/Pose "
                        "functions, or set Examples/Weight penalty to auto.");
    std::ostringstream text;
    text << which << " is " << (least.ratio < 1e-12 ? "" : "nearly ") << combination
         << " (their Gram matrix " << condition_of(differences, least.ratio) << "). "
         << (has_ridge
                 ? "The weight penalty decides between them; remove the example if it is there "
                   "by mistake."
                 : "Their weights are sensitive; remove the example, or set Examples/Weight "
                   "penalty to auto.");
    warnings.push_back(text.str());
  }

  // The KKT conditions of the weights.

  namespace
  {
    /// Optimality condition of a weight: zero is between its one-sided derivatives plus the
    /// multiplier or, at the bound, not above the right one.
    struct Condition
    {
      WeightMemory::Slopes slopes;
      bool                 can_fall, can_rise; ///< whether a bound is not in the way

      bool
      is_free() const
      {
        return can_fall && can_rise && !(slopes.up > slopes.down);
      }

      double
      deviation(const double multiplier) const
      {
        const double up = slopes.up + multiplier, down = slopes.down + multiplier;
        if (is_free())
          return up;
        return std::max({ can_rise ? -up : 0., can_fall ? down : 0., 0. });
      }
    };

    /// The multiplier of a region: minus the mean derivative by its free weights; without free
    /// ones, the middle of the interval that the other weights' conditions allow.
    double
    multiplier_of(const std::vector<Condition> &region)
    {
      double       sum = 0., least = -std::numeric_limits<double>::infinity(), greatest = -least;
      unsigned int n = 0;
      for (const Condition &condition : region)
      {
        if (condition.is_free())
        {
          sum += condition.slopes.up;
          ++n;
        }
        least = std::max(least, -condition.slopes.up);
        if (condition.can_fall)
          greatest = std::min(greatest, -condition.slopes.down);
      }
      return n > 0 ? -sum / n : 0.5 * (least + greatest);
    }
  } // namespace

  WeightResidual
  ExampleWeights::residual(const std::vector<double> &weights,
                           const std::vector<double> &gradient) const
  {
    const unsigned int n_groups = additive ? n_unknown() : form.N.m();
    const unsigned int k        = additive ? 1 : n_per_region();
    WeightResidual     result;
    if (!held.empty()) // held weights need no optimality
    {
      result.multipliers.assign(form.N.m(), 0.);
      return result;
    }
    MaxMagnitude deviation;
    for (unsigned int group = 0; group < n_groups; ++group)
    {
      std::vector<Condition> conditions;
      for (unsigned int weight = group * k; weight < (group + 1) * k; ++weight)
        conditions.push_back({ memory.slopes(weight, weights[weight], gradient[weight]),
                               can_fall(weights[weight]), can_rise(weights[weight]) });
      const double multiplier = additive ? 0. : multiplier_of(conditions);
      if (!additive)
        result.multipliers.push_back(multiplier);
      for (const Condition &condition : conditions)
        deviation.add(condition.deviation(multiplier));
    }
    result.deviation = deviation.value();
    return result;
  }
} // namespace Exemplar
