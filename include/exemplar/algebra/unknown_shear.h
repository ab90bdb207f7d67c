// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_unknown_shear_h
#define exemplar_unknown_shear_h

#include <cstddef>
#include <vector>

namespace Exemplar
{
  /// A change of unknowns u = T v in which a matrix T^T A T is sparser than A: some unknowns are u_k = v_k - sum_j n_kj v_j, with
  /// others that stay as they are.
  struct UnknownShear
  {
    std::vector<unsigned int> sheared; ///< k
    std::vector<std::size_t>  ends;    ///< end of the others of each
    std::vector<unsigned int> others;  ///< j
    std::vector<double>       factors; ///< n_kj

    void
    clear()
    {
      sheared.clear();
      ends.clear();
      others.clear();
      factors.clear();
    }

    /// Overwrite u by v = T^-1 u.
    void
    to_sheared(double *u) const
    {
      combine(1., u);
    }

    /// Overwrite v by u = T v.
    void
    from_sheared(double *v) const
    {
      combine(-1., v);
    }

    /// Overwrite forces, by u, by those by v, T^T f.
    void
    forces_to_sheared(double *forces) const
    {
      spread(-1., forces);
    }

    /// Overwrite forces by v by those by u.
    void
    forces_from_sheared(double *forces) const
    {
      spread(1., forces);
    }

    /// In bytes.
    std::size_t
    memory_consumption() const
    {
      return sizeof(unsigned int) * (sheared.capacity() + others.capacity())
             + sizeof(std::size_t) * ends.capacity() + sizeof(double) * factors.capacity();
    }

  private:
    void
    combine(const double sign, double *vector) const
    {
      for (std::size_t k = 0, i = 0; k < sheared.size(); ++k)
      {
        double sum = 0.;
        for (; i < ends[k]; ++i)
          sum += factors[i] * vector[others[i]];
        vector[sheared[k]] += sign * sum;
      }
    }

    void
    spread(const double sign, double *forces) const
    {
      for (std::size_t k = 0, i = 0; k < sheared.size(); ++k)
        for (const double force = sign * forces[sheared[k]]; i < ends[k]; ++i)
          forces[others[i]] += factors[i] * force;
    }
  };
} // namespace Exemplar

#endif
