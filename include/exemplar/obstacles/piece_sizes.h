// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_piece_sizes_h
#define exemplar_piece_sizes_h

#include <exemplar/body/fe_space.h>

#include <string>
#include <vector>

namespace Exemplar
{
  /// The sizes of the pieces of a body, from which contact has its automatic lengths.
  struct PieceSizes
  {
    /// The diameters are those of the whole body's pieces. All processes must call this.
    PieceSizes(const Mesh &mesh, const FESpace &fe_space);

    /// One piece of this diameter [m].
    explicit PieceSizes(const double diameter) : diameters({ diameter }) {}

    std::vector<unsigned int> pieces;    ///< of the nodes of this process
    std::vector<double>       diameters; ///< of the pieces: diagonals of their boxes [m]
  };

  /// One number per piece, or one for all pieces.
  struct PieceLengths
  {
    std::vector<double>       of_pieces; ///< one number alone: of all pieces
    std::vector<unsigned int> pieces;    ///< of the nodes; empty: all have the same number

    /// That of a node's piece.
    double
    at(const unsigned int node) const
    {
      return of_pieces[pieces.empty() ? 0 : pieces[node]];
    }

    double
    greatest() const;
  };

  /// The distances [m] from which contact pushes the pieces of a body, by the text of a key: a number [m], or auto, which is 5e-3
  /// of the diameter of each piece. Throws UserError for a number above a tenth of `diameter` [m] or below a millionth of it.
  PieceLengths
  contact_distances(const std::string &text,
                    const std::string &key,
                    double             diameter,
                    const PieceSizes  &sizes);

  /// The speeds [m/s] from which friction of the pieces is that of a sliding contact, by the text of a key: a number, or auto,
  /// which is 1e-3 of the diameter of each piece per second.
  PieceLengths
  contact_slip_speeds(const std::string &text, const PieceSizes &sizes);
} // namespace Exemplar

#endif
