// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/message_text.h>
#include <exemplar/base/number_text.h>
#include <exemplar/body/dependent_poses.h>

#include <deal.II/lac/lapack_full_matrix.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace Exemplar
{
  namespace
  {
    /// A combination of strains is small below this part of the strains themselves.
    constexpr double small_combination = 0.03;

    /// Examples with a lesser part in a combination, over the greatest one, are not counted.
    constexpr double least_part = 0.1;

    /// Poses with less strain in a region than this part of the greatest one hardly act there.
    constexpr double least_strain = 1e-3;

    /// Curvature of the penalty along a combination of length one, over that of a pose's strains. Then weights
    /// change by less than 3 times as much with the strains that determine them as those of one pose do, for a combination of any
    /// size below `small_combination`; by up to 2.7 times where rounding to a power of two takes 30 %.
    constexpr double curvature = 0.014;

    /// Weights of a region whose examples have strains there.
    std::vector<unsigned int>
    strained_weights(const ExampleTargets &targets, const unsigned int region)
    {
      const auto energy = [&](const unsigned int weight) { return targets.gram()(weight, weight); };
      double     greatest = 0.;
      for (unsigned int weight = region * targets.size(); weight < (region + 1) * targets.size();
           ++weight)
        greatest = std::max(greatest, energy(weight));
      std::vector<unsigned int> weights;
      for (unsigned int weight = region * targets.size(); weight < (region + 1) * targets.size();
           ++weight)
        if (targets.is_strained(weight) && energy(weight) > 0.
            && energy(weight) >= least_strain * least_strain * greatest)
          weights.push_back(weight);
      return weights;
    }

    /// The Gram matrix of these weights, scaled to a unit diagonal.
    dealii::FullMatrix<double>
    scaled_gram(const ExampleTargets &targets, const std::vector<unsigned int> &weights)
    {
      const auto                &gram = targets.gram();
      const unsigned int         n    = weights.size();
      dealii::FullMatrix<double> scaled(n, n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          scaled(i, j) = gram(weights[i], weights[j])
                         / std::sqrt(gram(weights[i], weights[i]) * gram(weights[j], weights[j]));
      return scaled;
    }

    double
    form_of(const dealii::FullMatrix<double> &matrix, const std::vector<double> &a)
    {
      double sum = 0.;
      for (unsigned int i = 0; i < a.size(); ++i)
        for (unsigned int j = 0; j < a.size(); ++j)
          sum += a[i] * matrix(i, j) * a[j];
      return sum;
    }

    /// Add a curvature along the sum of the weights, which is then no small combination.
    void
    exclude_sum(const ExampleTargets            &targets,
                const std::vector<unsigned int> &weights,
                dealii::FullMatrix<double>      &scaled)
    {
      const unsigned int  n = weights.size();
      std::vector<double> sum;
      double              square = 0.;
      for (const unsigned int weight : weights)
      {
        sum.push_back(1. / std::sqrt(targets.gram()(weight, weight)));
        square += sum.back() * sum.back();
      }
      dealii::FullMatrix<double> projection(n, n), product(n, n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          projection(i, j) = (i == j ? 1. : 0.) - sum[i] * sum[j] / square;
      projection.mmult(product, scaled);
      product.mmult(scaled, projection);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          scaled(i, j) += sum[i] * sum[j] / square;
    }

    /// Eigenvectors of eigenvalues below a bound, as rows.
    std::vector<std::vector<double>>
    small_eigenvectors(const dealii::FullMatrix<double> &matrix, const double bound)
    {
      const unsigned int               n = matrix.m();
      dealii::LAPACKFullMatrix<double> symmetric(n, n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          symmetric(i, j) = 0.5 * (matrix(i, j) + matrix(j, i));
      dealii::Vector<double>     values(n);
      dealii::FullMatrix<double> vectors;
      symmetric.compute_eigenvalues_symmetric(-1., bound, 0., values, vectors);
      std::vector<std::vector<double>> rows;
      for (unsigned int k = 0; k < values.size(); ++k)
      {
        rows.emplace_back();
        for (unsigned int i = 0; i < n; ++i)
          rows.back().push_back(vectors(i, k));
      }
      return rows;
    }

    /// A basis of the rows' span with many zeros: each row has a one in a column where the others have zeros.
    void
    reduce(std::vector<std::vector<double>> &rows)
    {
      for (std::size_t done = 0; done < rows.size(); ++done)
      {
        std::size_t row = done, column = 0;
        for (std::size_t r = done; r < rows.size(); ++r)
          for (std::size_t i = 0; i < rows[r].size(); ++i)
            if (std::abs(rows[r][i]) > std::abs(rows[row][column]) * (1. + 1e-9)) // not by rounding
            {
              row    = r;
              column = i;
            }
        std::swap(rows[done], rows[row]);
        const double pivot = rows[done][column];
        for (double &entry : rows[done])
          entry /= pivot;
        for (std::size_t r = 0; r < rows.size(); ++r)
          if (const double factor = rows[r][column]; r != done)
            for (std::size_t i = 0; i < rows[r].size(); ++i)
              rows[r][i] -= factor * rows[done][i];
      }
    }

    /// The examples of a combination, without those that hardly take part.
    DependentPoses
    poses_of(const std::vector<double>        &row,
             const std::vector<unsigned int>  &weights,
             const ExampleTargets             &targets,
             const dealii::FullMatrix<double> &scaled)
    {
      double greatest = 0., square = 0.;
      for (const double part : row)
      {
        greatest = std::max(greatest, std::abs(part));
        square += part * part;
      }
      DependentPoses poses{ {}, {}, std::sqrt(std::max(form_of(scaled, row), 0.) / square), false };
      double         length = 0., sum = 0., sizes = 0.; // of the a_i
      for (unsigned int i = 0; i < row.size(); ++i)
        if (std::abs(row[i]) >= least_part * greatest)
        {
          poses.weights.push_back(weights[i]);
          poses.combination.push_back(row[i]);
          length += row[i] * row[i];
          const double a = row[i] / std::sqrt(targets.gram()(weights[i], weights[i]));
          sum += a;
          sizes += std::abs(a);
        }
      poses.involves_rest = std::abs(sum) > least_part * sizes;
      const double sign   = poses.involves_rest && sum < 0. ? -1. : 1.;
      for (double &part : poses.combination)
        part *= sign / std::sqrt(length);
      return poses;
    }
  } // namespace

  std::vector<DependentPoses>
  find_dependent_poses(const ExampleTargets &targets, const bool has_rest)
  {
    std::vector<DependentPoses> all;
    for (unsigned int region = 0; region < targets.n_regions(); ++region)
    {
      const std::vector<unsigned int> weights = strained_weights(targets, region);
      if (weights.size() < 2)
        continue;
      dealii::FullMatrix<double> scaled = scaled_gram(targets, weights);
      if (!has_rest)
        exclude_sum(targets, weights, scaled);
      auto rows = small_eigenvectors(scaled, small_combination * small_combination);
      reduce(rows);
      for (const std::vector<double> &row : rows)
        all.push_back(poses_of(row, weights, targets, scaled));
    }
    return all;
  }

  namespace
  {
    /// The examples of a combination, by their places in it, whose weights are to be small.
    std::vector<unsigned int>
    unwanted(const DependentPoses &poses)
    {
      std::vector<unsigned int> increasing, decreasing;
      for (unsigned int i = 0; i < poses.weights.size(); ++i)
        (poses.combination[i] > 0. ? increasing : decreasing).push_back(i);
      if (poses.involves_rest || decreasing.empty())
        return increasing; // the weight of the rest pose decreases
      // products of two weights leave most weights unchanged, and one pose can always be left out
      const auto rank = [](const std::vector<unsigned int> &side) {
        return side.size() == 2 ? 0 : side.size() == 1 ? 1 : 2;
      };
      return rank(decreasing) < rank(increasing) ? decreasing : increasing;
    }

    /// The power of two next to a positive number.
    double
    power_of_two(const double number)
    {
      return std::exp2(std::round(std::log2(number)));
    }

    /// Whether the combination exchanges one pose for another, of which none is preferred.
    bool
    is_exchange(const DependentPoses &poses)
    {
      return poses.weights.size() == 2 && !poses.involves_rest
             && poses.combination[0] * poses.combination[1] < 0.;
    }

    /// Add the penalty along one combination.
    void
    add_preference(const DependentPoses       &poses,
                   const ExampleTargets       &targets,
                   const double                unit_energy,
                   dealii::FullMatrix<double> &form)
    {
      const double unit  = unit_energy * targets.fractions()[poses.weights[0] / targets.size()];
      const auto   price = [&](const unsigned int v, const unsigned int w)
      { return std::sqrt(targets.gram()(v, v) * targets.gram()(w, w)) / unit; };
      if (is_exchange(poses))
      {
        const unsigned int v = poses.weights[0], w = poses.weights[1];
        const double       entry = power_of_two(0.5 * curvature * price(v, w));
        form(v, v) += entry;
        form(w, w) += entry;
        form(v, w) -= entry;
        form(w, v) -= entry;
        return;
      }
      const std::vector<unsigned int> places = unwanted(poses);
      const bool                      is_one = places.size() == 1;
      double                          along  = 0.; // the form's curvature with entries of one
      for (const unsigned int i : places)
        for (const unsigned int j : places)
          if (is_one || i != j)
            along += poses.combination[i] * poses.combination[j];
      for (const unsigned int i : places)
        for (const unsigned int j : places)
          if (is_one || i != j)
            form(poses.weights[i], poses.weights[j])
                += power_of_two(curvature / along * price(poses.weights[i], poses.weights[j]));
    }

    /// Whether the Gram matrix plus a form over the regions' unit energies is positive definite, with a margin.
    bool
    is_convex_with(const dealii::FullMatrix<double> &form,
                   const ExampleTargets             &targets,
                   const bool                        has_rest,
                   const double                      unit_energy)
    {
      for (unsigned int region = 0; region < targets.n_regions(); ++region)
      {
        const std::vector<unsigned int> weights = strained_weights(targets, region);
        const double                    unit    = unit_energy * targets.fractions()[region];
        dealii::FullMatrix<double>      scaled  = scaled_gram(targets, weights);
        for (unsigned int i = 0; i < weights.size(); ++i)
          for (unsigned int j = 0; j < weights.size(); ++j)
            scaled(i, j) += unit * form(weights[i], weights[j])
                            / std::sqrt(targets.gram()(weights[i], weights[i])
                                        * targets.gram()(weights[j], weights[j]));
        if (!has_rest && weights.size() > 1)
          exclude_sum(targets, weights, scaled);
        if (weights.size() > 1
            && !small_eigenvectors(scaled, 0.5 * small_combination * small_combination).empty())
          return false;
      }
      return true;
    }
  } // namespace

  dealii::FullMatrix<double>
  preference_of(const std::vector<DependentPoses> &all,
                const ExampleTargets              &targets,
                const bool                         has_rest,
                const double                       unit_energy)
  {
    if (all.empty())
      return dealii::FullMatrix<double>(0, 0);
    dealii::FullMatrix<double> products(targets.n_weights(), targets.n_weights());
    for (const DependentPoses &poses : all)
      add_preference(poses, targets, unit_energy, products);
    // products of weights are not convex along differences of these; squares of their sums are
    dealii::FullMatrix<double> form = products;
    for (const double part : { 0.25, 0.5, 1. })
    {
      if (is_convex_with(form, targets, has_rest, unit_energy))
        break;
      form = products;
      for (unsigned int i = 0; i < form.m(); ++i)
        for (unsigned int j = 0; j < form.n(); ++j)
          if (i != j && products(i, j) > 0.)
            form(i, i) += part * products(i, j);
    }
    return form;
  }

  std::string
  describe(const DependentPoses &poses, const ExampleTargets &targets, const bool has_rest)
  {
    std::vector<std::string> names;
    for (const unsigned int weight : poses.weights)
    {
      const unsigned int example = weight % targets.size();
      names.push_back(fmt::format("{} ({})", targets.number(example), targets.name(example)));
    }
    const auto        region = targets.region_id(poses.weights[0] / targets.size());
    const std::string part   = poses.remainder < 1e-4 ? "0.01" : short_text(100. * poses.remainder);
    return fmt::format("Examples {}{}: a combination of their strains is {} {} % of the strains, "
                       "so that the energy hardly "
                       "determines their weights. A penalty along this combination prefers {}; "
                       "positions change by up to some {} % of "
                       "the poses' displacements. If poses are there by mistake, remove them.",
                       joined(names, poses.weights.size() == 2 ? " and " : ", "),
                       region ? fmt::format(", region {}", *region) : "",
                       poses.remainder < 1e-4 ? "less than" : "only", part,
                       is_exchange(poses) ? "equal weights"
                       : poses.involves_rest && has_rest && targets.first_strained() > 0
                           ? "the rest pose"
                       : poses.involves_rest && has_rest ? "weights of 0"
                                                         : "the poses between the others",
                       part);
  }
} // namespace Exemplar
