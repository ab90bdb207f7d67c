// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/outer_product_rows.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <set>

namespace Exemplar
{
  namespace
  {
    using ByProcess = std::map<unsigned int, OuterProducts>;

    /// Send products to each process; returns the received ones.
    ByProcess
    swap_products(const ByProcess &products, const Exchange &exchange)
    {
      if (exchange.n_processes() == 1)
        return {};
      return dealii::Utilities::MPI::some_to_some(exchange.communicator(), products);
    }

    void
    add_product(const OuterProducts &from, const std::size_t product, OuterProducts &to)
    {
      const auto begin = from.begin(product), end = from.ends[product];
      to.add(from.factors[product], { from.blocks.begin() + begin, from.blocks.begin() + end },
             { from.values.begin() + 3 * begin, from.values.begin() + 3 * end });
    }
  } // namespace

  template <typename Number>
  OuterProductRows<Number>::OuterProductRows(const OuterProducts            &made_here,
                                             const std::vector<std::size_t> &firsts,
                                             const Exchange                 &exchange)
  {
    const std::size_t first  = firsts[exchange.process()],
                      n_own  = firsts[exchange.process() + 1] - first;
    const ByProcess received = share_products(made_here, firsts, exchange);
    append(made_here);
    for (const auto &[process, products] : received) // sums in the order of the processes
    {
      n_known_of[process] = products.size();
      append(products);
    }
    number_blocks(first, n_own);
    find_rows(n_own);
    values.resize(values.size() + read_beyond, Number());
    halo = Halo(firsts, others, n_each, exchange);
  }

  template <typename Number>
  ByProcess
  OuterProductRows<Number>::share_products(const OuterProducts            &made_here,
                                           const std::vector<std::size_t> &firsts,
                                           const Exchange                 &exchange)
  {
    ByProcess for_others;
    for (std::size_t product = 0; product < made_here.size(); ++product)
    {
      std::set<unsigned int> owners;
      for (std::size_t k = made_here.begin(product); k < made_here.ends[product]; ++k)
        owners.insert(std::upper_bound(firsts.begin(), firsts.end(), made_here.blocks[k])
                      - firsts.begin() - 1);
      owners.erase(exchange.process());
      for (const unsigned int owner : owners)
      {
        add_product(made_here, product, for_others[owner]);
        known_to[owner].push_back(product);
      }
    }
    return swap_products(for_others, exchange);
  }

  template <typename Number>
  void
  OuterProductRows<Number>::append(const OuterProducts &products)
  {
    for (const std::size_t end : products.ends)
      start.push_back(static_cast<int>(blocks.size() + end));
    factors.insert(factors.end(), products.factors.begin(), products.factors.end());
    blocks.insert(blocks.end(), products.blocks.begin(), products.blocks.end());
    values.insert(values.end(), products.values.begin(), products.values.end());
  }

  template <typename Number>
  void
  OuterProductRows<Number>::number_blocks(const std::size_t first, const std::size_t n_own)
  {
    const auto is_own
        = [&](const int block) { return static_cast<std::size_t>(block) - first < n_own; };
    for (const int block : blocks)
      if (!is_own(block))
        others.push_back(block);
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    for (int &block : blocks)
      block = static_cast<int>(
          is_own(block)
              ? block - first
              : n_own + (std::lower_bound(others.begin(), others.end(), block) - others.begin()));
  }

  template <typename Number>
  void
  OuterProductRows<Number>::find_rows(const std::size_t n_own)
  {
    row_start.assign(n_own + 1, 0);
    for (const int block : blocks)
      if (static_cast<std::size_t>(block) < n_own)
        ++row_start[block + 1];
    for (std::size_t row = 0; row < n_own; ++row)
      row_start[row + 1] += row_start[row];
    product_of.resize(row_start[n_own]);
    entry_of.resize(row_start[n_own]);
    std::vector<int> next = row_start;
    for (std::size_t product = 0; product < factors.size(); ++product)
      for (int entry = start[product]; entry < start[product + 1]; ++entry)
        if (const int row = blocks[entry]; static_cast<std::size_t>(row) < n_own)
        {
          product_of[next[row]] = static_cast<int>(product);
          entry_of[next[row]++] = entry;
        }
  }

  template <typename Number>
  std::vector<Number>
  OuterProductRows<Number>::coefficients(const Number *x) const
  {
    std::vector<Number> of_others(halo.n_others()), result(factors.size());
    halo.share(x, of_others.data());
    const std::size_t n_own = row_start.empty() ? 0 : row_start.size() - 1;
    for (std::size_t product = 0; product < factors.size(); ++product)
    {
      Number sum[3] = { 0, 0, 0 };
      for_each_block(product,
                     [&](const std::size_t block, const Number *u)
                     {
                       const Number *v = block < n_own ? x + n_each * block
                                                       : &of_others[n_each * (block - n_own)];
                       for (int c = 0; c < 3; ++c)
                         sum[c] += u[c] * v[c];
                     });
      result[product] = factors[product] * (sum[0] + sum[1] + sum[2]);
    }
    return result;
  }

  namespace
  {
    /// A sparse vector: three numbers for each of some blocks.
    using Blocks = std::map<unsigned int, std::array<double, 3>>;

    void
    add_product_to(Blocks &sum, const OuterProducts &products, const std::size_t product)
    {
      for (std::size_t k = products.begin(product); k < products.ends[product]; ++k)
      {
        std::array<double, 3> &of_block = sum[products.blocks[k]]; // zero at first
        for (int c = 0; c < 3; ++c)
          of_block[c] += products.values[3 * k + c];
      }
    }
  } // namespace

  template <typename Number>
  OuterProducts
  OuterProductRows<Number>::complete(const OuterProducts &parts, const Exchange &exchange) const
  {
    std::size_t n_foreign = 0;
    for (const auto &[process, n] : n_known_of)
      n_foreign += n;
    const std::size_t n_here = parts.size() - n_foreign;
    ByProcess         back;
    std::size_t       next = n_here;
    for (const auto &[process, n] : n_known_of)
      for (const std::size_t end = next + n; next < end; ++next)
        add_product(parts, next, back[process]);

    const ByProcess               received = swap_products(back, exchange);
    std::map<std::size_t, Blocks> of_shared;
    for (const auto &[process, products] : received) // sums in the order of the processes
      for (std::size_t k = 0; k < products.size(); ++k)
        add_product_to(of_shared[known_to.at(process)[k]], products, k);

    OuterProducts result;
    for (std::size_t product = 0; product < n_here; ++product)
      if (const auto shared = of_shared.find(product); shared == of_shared.end())
        add_product(parts, product, result);
      else
      {
        add_product_to(shared->second, parts, product);
        std::vector<unsigned int> blocks_of_sum;
        std::vector<double>       values_of_sum;
        for (const auto &[block, sum] : shared->second)
        {
          blocks_of_sum.push_back(block);
          values_of_sum.insert(values_of_sum.end(), sum.begin(), sum.end());
        }
        result.add(parts.factors[product], blocks_of_sum, values_of_sum);
      }
    return result;
  }

  template <typename Number>
  std::size_t
  OuterProductRows<Number>::memory_consumption() const
  {
    return sizeof(Number) * (factors.capacity() + values.capacity())
           + sizeof(int)
                 * (start.capacity() + blocks.capacity() + row_start.capacity()
                    + product_of.capacity() + entry_of.capacity());
  }

  template class OuterProductRows<float>;
  template class OuterProductRows<double>;
} // namespace Exemplar
