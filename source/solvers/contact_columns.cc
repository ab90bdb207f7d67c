// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/solvers/contact_columns.h>

#include <algorithm>

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
      {
        const auto [factor, vector] = gap.derivative(i, gaps.row(r).direction);
        rows[r].push_back({ number_of(gap.nodes[i]), 3 * gap.nodes[i],
                            factor * metric.rotate_back(gap.nodes[i], vector) });
      }
    }
    return rows;
  }

  void
  ContactColumns::add_entries(const Part                     &row,
                              const std::vector<std::size_t> &nodes,
                              double                         *entries_of_row) const
  {
    const double x = row.direction[0], y = row.direction[1], z = row.direction[2];
    for (std::size_t k = 0; k < nodes.size(); ++k)
    {
      const bool        in_order = row.node >= nodes[k];
      const Block      &block  = in_order ? blocks[row.node][nodes[k]] : blocks[nodes[k]][row.node];
      const std::size_t by_row = in_order ? 3 : 1, by_column = in_order ? 1 : 3;
      for (std::size_t j = 0; j < 3; ++j)
        entries_of_row[3 * k + j] += x * block[by_column * j] + y * block[by_row + by_column * j]
                                     + z * block[2 * by_row + by_column * j];
    }
  }

  void
  ContactColumns::find_entries(const std::vector<std::vector<Part>> &rows,
                               dealii::FullMatrix<double>           &W) const
  {
    constexpr std::size_t    none = -1;
    std::vector<std::size_t> nodes, place(columns.size(), none); // among these
    for (const std::vector<Part> &row : rows)
      for (const Part &part : row)
        if (place[part.node] == none)
        {
          place[part.node] = nodes.size();
          nodes.push_back(part.node);
        }
    std::vector<double> line(3 * nodes.size());
    for (std::size_t r = 0; r < rows.size(); ++r)
    {
      std::fill(line.begin(), line.end(), 0.);
      for (const Part &part : rows[r])
        add_entries(part, nodes, line.data());
      for (std::size_t s = 0; s <= r; ++s)
      {
        double sum = 0.;
        for (const Part &part : rows[s])
        {
          const double *entry = &line[3 * place[part.node]];
          sum += entry[0] * part.direction[0] + entry[1] * part.direction[1]
                 + entry[2] * part.direction[2];
        }
        W(r, s) = sum;
      }
    }
  }

  void
  ContactColumns::add_correction(const std::vector<std::vector<Part>> &rows,
                                 const LbfgsCorrection                &correction,
                                 dealii::FullMatrix<double>           &W) const
  {
    const std::size_t m = rows.size(), k = correction.columns.size();
    if (m == 0 || k == 0)
      return;
    dealii::FullMatrix<double> B(k, m), MB(k, m);
    for (std::size_t r = 0; r < m; ++r)
      for (const Part &part : rows[r])
        for (unsigned int c = 0; c < 3; ++c)
          if (const int unknown = free_dofs.unknown_index(part.first_dof + c);
              unknown != FreeDofs::held)
            for (std::size_t l = 0; l < k; ++l)
              B(l, r) += part.direction[c] * (*correction.columns[l])[unknown];
    correction.matrix.mmult(MB, B);
    for (std::size_t r = 0; r < m; ++r)
      for (std::size_t l = 0; l < k; ++l)
      {
        const double  factor = MB(l, r);
        const double *line   = &B(l, 0);
        double       *sum    = &W(r, 0);
        for (std::size_t s = 0; s <= r; ++s)
          sum[s] += factor * line[s];
      }
  }

  dealii::FullMatrix<double>
  ContactColumns::between_rows(const GapEnergies &gaps, const LbfgsCorrection &correction)
  {
    follow_metric();
    const std::vector<std::vector<Part>> rows = parts_of(gaps);
    dealii::FullMatrix<double>           W(rows.size(), rows.size());
    find_entries(rows, W);
    add_correction(rows, correction, W);
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t s = 0; s < r; ++s)
        W(s, r) = W(r, s);
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
