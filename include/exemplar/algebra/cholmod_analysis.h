// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_cholmod_analysis_h
#define exemplar_cholmod_analysis_h

#include <exemplar/algebra/factor_structure.h>
#include <exemplar/algebra/spd_operator.h>

#include <cholmod.h>
#include <string>

namespace Exemplar
{
  /// CHOLMOD's workspace, set to supernodal factors and no output.
  class CholmodCommon
  {
  public:
    CholmodCommon();
    ~CholmodCommon();

    CholmodCommon(const CholmodCommon &) = delete;
    CholmodCommon &
    operator=(const CholmodCommon &)
        = delete;

    /// Join more small supernodes than CHOLMOD does, though more zeros are stored: our solves and factorisations wait
    /// longer at each than CHOLMOD's.
    void
    join_more_supernodes();

    cholmod_common *
    operator&()
    {
      return &common;
    }

    const cholmod_common *
    operator->() const
    {
      return &common;
    }

    /// Throws SolverFailure, naming the operation `what`, if CHOLMOD's last call has failed.
    void
    check(const std::string &what) const;

  private:
    cholmod_common common{};
  };

  /// CHOLMOD's view of the matrix with these values, which may be null; nothing is copied.
  cholmod_sparse
  cholmod_view(const SymmetricPattern &pattern, const double *values);

  /// CHOLMOD's symbolic analysis of a pattern in this order of elimination, which it refines, or, if
  /// that is empty, in the ordering with the least expected fill, of a surface by nested dissection. The caller frees the factor.
  /// Throws SolverFailure.
  cholmod_factor *
  analyze(const SymmetricPattern &pattern,
          CholmodCommon          &common,
          const std::vector<int> &order = {});

  /// The structure of the factor in CHOLMOD's analysis of a pattern.
  FactorStructure
  factor_structure(const SymmetricPattern &pattern,
                   const cholmod_factor   &factor,
                   const CholmodCommon    &common);
} // namespace Exemplar

#endif
