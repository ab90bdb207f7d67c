// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/contact_columns.h>

namespace Exemplar
{
  namespace
  {
    constexpr std::size_t max_nodes
        = 600; ///< whose entries are kept; more have gone from contact by then
  }            // namespace

  ContactColumns::ContactColumns(const FreeDofs &free_dofs, const RotatedMetric &metric)
      : free_dofs(free_dofs), metric(metric)
  {
  }

  void
  ContactColumns::follow_metric()
  {
    if (version == metric.version() && numbers.size() <= max_nodes)
      return;
    clear();
    version = metric.version();
    entries = metric.entries();
  }

  void
  ContactColumns::clear()
  {
    version = 0; // which no metric has
    entries.reset();
    numbers.clear();
    columns.clear();
    blocks.clear();
  }

  bool
  ContactColumns::has_entries()
  {
    follow_metric();
    return entries != nullptr;
  }

  std::size_t
  ContactColumns::number_of(const unsigned int node)
  {
    const auto [place, is_new] = numbers.emplace(node, columns.size());
    if (!is_new)
      return place->second;
    std::array<int, 3> own;
    for (unsigned int c = 0; c < 3; ++c)
    {
      const int unknown = free_dofs.unknown_index(3 * node + c);
      own[c]            = unknown == FreeDofs::held ? -1 : static_cast<int>(entries->add(unknown));
    }
    columns.push_back(own);
    std::vector<Block> line(columns.size());
    for (std::size_t b = 0; b < columns.size(); ++b)
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          line[b][3 * i + j]
              = own[i] == -1 || columns[b][j] == -1 ? 0. : entries->entry(own[i], columns[b][j]);
    blocks.push_back(std::move(line));
    return place->second;
  }

  std::vector<std::vector<ContactColumns::Part>>
  ContactColumns::parts_of(const GapEnergies &gaps)
  {
    std::vector<std::vector<Part>> rows(gaps.n_rows());
    for (std::size_t r = 0; r < gaps.n_rows(); ++r)
    {
      const Gap &gap = gaps.gap_of(r);
      for (unsigned int i = 0; i < gap.n_nodes; ++i)
        rows[r].push_back(
            { number_of(gap.nodes[i]), 3 * gap.nodes[i],
              gap.coefficients[i] * metric.rotate_back(gap.nodes[i], gaps.row(r).direction) });
    }
    return rows;
  }

  double
  ContactColumns::product(const Part &a, const Part &b) const
  {
    const bool   in_order = a.node >= b.node;
    const Block &block    = in_order ? blocks[a.node][b.node] : blocks[b.node][a.node];
    double       sum      = 0.;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        sum += a.direction[i] * (in_order ? block[3 * i + j] : block[3 * j + i]) * b.direction[j];
    return sum;
  }

  dealii::FullMatrix<double>
  ContactColumns::between_rows(const GapEnergies &gaps, const LbfgsCorrection &correction)
  {
    follow_metric();
    const std::vector<std::vector<Part>> rows = parts_of(gaps);
    const std::size_t                    m = rows.size(), k = correction.columns.size();
    dealii::FullMatrix<double>           W(m, m), B(m, k), BM(m, k);
    for (std::size_t r = 0; r < m; ++r)
      for (std::size_t s = 0; s <= r; ++s)
      {
        for (const Part &a : rows[r])
          for (const Part &b : rows[s])
            W(r, s) += product(a, b);
        W(s, r) = W(r, s);
      }
    if (m == 0 || k == 0)
      return W;
    for (std::size_t r = 0; r < m; ++r)
      for (std::size_t l = 0; l < k; ++l)
        for (const Part &a : rows[r])
          for (unsigned int c = 0; c < 3; ++c)
            if (const int unknown = free_dofs.unknown_index(a.first_dof + c);
                unknown != FreeDofs::held)
              B(r, l) += a.direction[c] * (*correction.columns[l])[unknown];
    B.mmult(BM, correction.matrix);
    for (std::size_t r = 0; r < m; ++r)
      for (std::size_t s = 0; s <= r; ++s)
      {
        for (std::size_t l = 0; l < k; ++l)
          W(r, s) += BM(r, l) * B(s, l);
        W(s, r) = W(r, s);
      }
    return W;
  }

  std::size_t
  ContactColumns::memory_consumption() const
  {
    std::size_t bytes = entries == nullptr ? 0 : entries->memory_consumption();
    for (const std::vector<Block> &line : blocks)
      bytes += sizeof(Block) * line.capacity();
    return bytes;
  }
} // namespace Exemplar
