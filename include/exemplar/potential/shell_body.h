// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_shell_body_h
#define exemplar_shell_body_h

#include <exemplar/body/example_weights.h>
#include <exemplar/body/fe_space.h>
#include <exemplar/body/material.h>
#include <exemplar/body/shell_strains.h>
#include <exemplar/body/target_block.h>
#include <exemplar/kernels/shell_kernels.h>
#include <exemplar/potential/elastic_body.h>
#include <exemplar/potential/volume_resistance.h>

#include <cmath>
#include <vector>

namespace Exemplar
{
  /// What the body of a shell is: its triangles, which are the cells of its material and the points of
  /// its examples. All must outlive whoever holds this.
  struct ShellParts
  {
    const ShellMesh       &mesh;
    const FESpace         &fe_space; ///< for its exchange and its order of cells alone
    const Material        &material;
    const ExampleTargets  &examples;
    const TargetBlock     &targets; ///< strains, see ShellStrain
    const EnclosedVolumes &volumes; ///< that resist; none where Material::volume_stiffness() is 0
    const TargetBlock     &targets_of_volumes; ///< changes of these, see VolumeResistance
    ExampleWeights        &weights;
    const FreeDofs
        &free_dofs; ///< a slope node of which the first component is held is held as a whole
    unsigned int    n_threads = 1; ///< of the loops; no result depends on it
    const HeldTips *held_tips
        = nullptr; ///< where slope nodes are held; null: all components of these are
  };

  /// The body of a shell: of each triangle the energy volume/2 (e - D):C:(e - D) of its six strains, in plane
  /// stress, in which membrane and curvature have the same form because the latter is scaled.
  class ShellBody : public ElasticBody
  {
  public:
    /// Needs attach() before all else.
    explicit ShellBody(const ShellParts &parts);

    SymmetricPattern
    make_pattern(const NodePairs &more, bool in_parts) const override;

    bool
    couples_by_products() const override
    {
      return false;
    }

    bool
    has_dense_products() const override
    {
      return !volumes.empty();
    }

    bool
    shears_unknowns() const override
    {
      return parts.mesh.n_slopes() > 0;
    }

    /// The matrix is by the turns of mid-edge normals in space, not out of bisectors as slopes are: so it couples the vertices
    /// and edges of each triangle, and none beyond.
    void
    find_shear(const Vector &positions, UnknownShear &shear) const override;

    void
    attach(const SymmetricPattern &pattern) override;

    void
    follow_parameters() override;

    void
    begin_step(double s, const std::vector<WeightedPositions> &past) override;

    void
    leave_step() override;

    void
    set_step_size(double /*size*/) override
    {
    }

    const CellOrder &
    history_order() const override
    {
      return parts.fe_space.cell_order();
    }

    bool
    remembers() const override
    {
      return false;
    }

    /// The branches of angles, which are memory, too: ShellStrains::branches().
    std::vector<double>
    initial_history() const override
    {
      return ShellStrains(parts.mesh).branches();
    }

    void
    set_history(const std::vector<double> &history) override;

    /// Angles are on the branch of these positions from now on.
    std::vector<double>
    advance_history(const Vector &positions) override;

    void
    update_rotations(const Vector &positions) override;

    /// A vertex turns by the rotation that fits its triangles best; slope nodes do not turn.
    void
    node_rotations(std::vector<float> &rotations) override;

    void
    evaluate(const Vector              &positions,
             const std::vector<double> &weights,
             ElasticEvaluation         &evaluation,
             RotationUse                rotations   = RotationUse::keep,
             const std::vector<double> *linear_term = nullptr) override;

    void
    assemble_tangent(Tangent                    tangent,
                     const Vector              &positions,
                     const std::vector<double> &weights,
                     std::vector<double>       &matrix_values,
                     std::vector<double>       &columns,
                     OuterProducts             *products = nullptr) override;

    void
    add_response(Tangent                    tangent,
                 const Vector              &displacement,
                 const Vector              &positions,
                 const std::vector<double> &weights,
                 ElasticEvaluation         &evaluation) override;

    /// Add the changes of all forces by a displacement of any nodes, by the exact tangent, that of damping included.
    void
    add_exact_response(const Vector              &displacement,
                       const Vector              &positions,
                       const std::vector<double> &weights,
                       Vector                    &gradient);

    std::vector<double>
    weight_linear_term(const Vector &positions, RotationUse rotations = RotationUse::keep) override;

    double
    rounding_force(double size) const override;

    /// Membranes are stiff beside what bends: their strains are small, and their energy is lost in rounding first.
    double
    rounding_energy(const ElasticEvaluation &at) const override
    {
      return strain_of_rounding * std::sqrt(at.stress_square);
    }

    double
    rounding_weight_gradient() const override;

    /// The von Mises stress is the greater one of the two faces.
    CellResults
    cell_results(const Vector &positions, const std::vector<double> &weights) override;

    /// The elasticity of a triangle.
    const ShellElasticity &
    elasticity(const unsigned int triangle) const
    {
      return elasticities[triangle];
    }

    const ShellStrains &
    get_strains() const
    {
      return strains;
    }

    std::size_t
    memory_consumption() const override;

    bool
    keeps_its_tangent() const override
    {
      return false;
    }

  private:
    /// Three vertices, and a slope or a node more for each edge.
    static constexpr unsigned int max_dofs = 18;

    static constexpr unsigned int max_entries = max_dofs * (max_dofs + 1) / 2;

    /// The degrees of freedom that the strains of a triangle depend on, with the unknowns sheared.
    struct TriangleDofs
    {
      unsigned int                       n = 0;
      std::array<unsigned int, max_dofs> dofs{};
      std::array<std::array<unsigned int, 4>, 3>
          hinges{}; ///< index of the first one of each node, by edge that is not sheared
      std::array<unsigned int, 3>  slopes{};               ///< their indices, by edge
      bool                         is_beside_held = false; ///< or its turns' hinges are
      std::array<int, max_entries> positions{}; ///< of the lower triangle by rows; -1: held
    };

    /// What the loops read of hinges and triangles and what they find, as HingeTask and TriangleTask say.
    struct Arrays
    {
      std::vector<unsigned int>     hinge_nodes, nodes, hinges, slopes;
      dealii::AlignedVector<double> rest_angles, last_angles, changes, forms, lengths;
      dealii::AlignedVector<double> rest, past, strains, targets, areas, frames, found, products;
    };

    /// What a triangle adds to a matrix: the derivatives of its strains by its degrees of freedom,
    /// and C of these.
    struct TriangleTangent
    {
      std::array<MembraneChange<double>, 9> changes; ///< by the vertices
      std::array<ShellStrain, max_dofs>     B, CB;
      std::array<double, max_entries>       entries; ///< lower triangle by rows [N/m]
    };

    TriangleDofs
    find_dofs(unsigned int triangle) const;

    /// find_shear(), by index_of(degree of freedom).
    template <typename IndexOf>
    UnknownShear
    shear_by(const Vector &positions, const IndexOf &index_of) const;

    /// Add the product of a triangle's matrix.
    void
    add_product(unsigned int           triangle,
                const TriangleTangent &tangent,
                const Vector          &displacement,
                Vector                &gradient) const;

    /// Write what the loops read of the shell at rest: where hinges are others.
    void
    write_hinges();

    /// The same of the constants of triangles.
    void
    write_triangles();

    /// Let the loops know on which branch angles are.
    void
    write_branches();

    TriangleTask
    triangle_task(const Vector &positions, const std::vector<double> *weights, bool with_frames);

    /// Call loop(begin, end) for the batches of n things, in several threads.
    template <typename Loop>
    void
    for_each_batch(std::size_t n, const Loop &loop) const;

    /// Find the changes of hinges' angles and their derivatives.
    void
    find_hinges(const Vector &positions);

    /// Find hinges and strains.
    void
    find_strains(const Vector &positions, RotationUse rotations);

    /// Find what follows from strains and weights: energies, forces, and the moments of hinges.
    void
    find_stresses(const Vector &positions, const std::vector<double> &weights);

    /// One of TriangleResult.
    double
    found(const unsigned int triangle, const std::size_t number) const
    {
      return arrays.found[batch_index(triangle, TriangleResult::size, number)];
    }

    /// Six numbers of a triangle.
    static ShellStrain
    numbers_of(const dealii::AlignedVector<double> &of, unsigned int triangle);

    /// C:(e - D) with that of damping.
    ShellStrain
    driven_stress(unsigned int triangle) const;

    void
    add_energies(ElasticSums &sums) const;

    /// Add the forces at vertices and slopes, and those of hinges.
    void
    add_forces(ElasticSums &sums);

    /// Add factor times the product of the strains' stress, or of that beyond the targets, with what each weight asks for.
    void
    add_weight_products(bool of_strain_alone, double factor, std::vector<double> &sums);

    /// Add that for a stress in a triangle.
    void
    add_weight_products(unsigned int         triangle,
                        const ShellStrain   &stress,
                        double               factor,
                        std::vector<double> &sums) const;

    ShellStrain
    example_strain(unsigned int triangle, unsigned int example) const;

    void
    find_tangent(unsigned int     triangle,
                 Tangent          kind,
                 const Vector    &positions,
                 TriangleTangent &to) const;

    void
    find_strain_slopes(unsigned int                  triangle,
                       const TriangleStrain<double> &at,
                       const Vector                 &positions,
                       TriangleTangent              &to) const;

    void
    find_stretch_slopes(const TriangleStrain<double> &at,
                        const ShellTriangle          &triangle,
                        TriangleTangent              &to) const;

    void
    add_stretch_geometry(unsigned int                  triangle,
                         const TriangleStrain<double> &at,
                         bool                          convex,
                         TriangleTangent              &to) const;

    void
    add_membrane_geometry(unsigned int                  triangle,
                          const TriangleStrain<double> &at,
                          bool                          convex,
                          TriangleTangent              &to) const;

    /// Of the turn of the triangle's own normal about an edge.
    void
    add_turn_geometry(unsigned int                  triangle,
                      int                           edge,
                      const TriangleStrain<double> &at,
                      TriangleTangent              &to) const;

    /// Of the hinge at an edge.
    void
    add_hinge_geometry(unsigned int     triangle,
                       int              edge,
                       const Vector    &positions,
                       TriangleTangent &to) const;

    void
    add_columns(unsigned int           triangle,
                const TriangleTangent &of,
                std::vector<double>   &columns) const;

    void
    estimate_rounding();

    /// In bytes.
    std::size_t
    memory_of_arrays() const;

    const ShellParts             parts;
    ShellStrains                 strains;
    VolumeResistance             volumes;
    std::vector<ShellElasticity> elasticities;
    const SymmetricPattern      *pattern = nullptr; ///< since attach()
    std::vector<TriangleDofs>    dofs;              ///< since attach()
    double                       damping = 0.;      ///< s
    Arrays                       arrays;
    std::vector<std::array<double, 6>>
                        scales_at_rest; ///< of triangles: |gradients| [1/m], then |bending| [-]
    std::vector<double> moments,
        moment_scales;              ///< of hinges, since find_stresses() and add_forces() [N m]
    double rest_size          = 0.; ///< the greatest coordinate at rest [m]
    double force_of_rounding  = 0.; ///< greatest of a node [N]
    double stress_of_rounding = 0.; ///< (sum V T^2)^(1/2)
    double strain_of_rounding = 0.; ///< (sum V e^2)^(1/2) [m^(3/2)]
  };
} // namespace Exemplar

#endif
