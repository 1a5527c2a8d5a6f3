#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "subdomain_solver/contact/interference.hpp"
#include "subdomain_solver/contact/near_compliance.hpp"
#include "subdomain_solver/contact/port_contact.hpp"
#include "subdomain_solver/contact/seen_gaps.hpp"
#include "subdomain_solver/contact/surface_obstacle.hpp"
#include "subdomain_solver/contact/tied_neighbours.hpp"
#include "subdomain_solver/fe/cell_kernel.hpp"
#include "subdomain_solver/solve/friction_forces.hpp"
#include "subdomain_solver/solve/near_rows.hpp"
#include "subdomain_solver/solve/unilateral_forces.hpp"

namespace abut {

/// Contact of a solid in two or three dimensions: its ports are surfaces of nodes without mass,
/// each of which may meet several partners. One problem for all of them at the end of every
/// substep [M.88]: rows at the end's geometry, which the forces decide, so rows and forces are
/// found in turns. Rows that rub have tangents beside their normal [M.100].
class SurfaceContact final : public PortContact {
 public:
  struct Surface : PortSurface {
    std::vector<const Matrix3*> frames;  // by point; null: the axes of space
    bool loose = false;                  // contact alone holds its body (Description::stabilised)
  };
  /// `body`: its name, for people. Frames must outlive it. `interference`: absent, there is none
  /// that is wanted.
  SurfaceContact(std::vector<Surface> surfaces, const std::string& body,
                 std::optional<Interference> interference = {});

  /// What changes during a step beside the forces on ports.
  void state(Archive& archive);
  /// What partners pressed and where they stuck is forgotten; what friction took stays.
  void let_go();
  /// Throws RunError for what surfaces cannot take.
  void impose(const Window& window) override;
  bool acts() const override;
  bool acts(std::size_t port) const override;
  bool has(std::size_t port) const override;
  void hold(const std::vector<double>& forces, std::vector<double>& now) const override;
  void aim(int i, const std::vector<double>& forces, const std::vector<double>& places) override;
  void settle(std::vector<double>& forces) override;
  void react(std::size_t port, std::size_t partner, const std::vector<double>& forces,
             std::vector<double>& out) const override;
  /// Points of a partner that react() is of in this window, ascending, empty: all; more of them as
  /// the window goes on. Null: those that its obstacle lists.
  const std::vector<std::int32_t>* reacting(std::size_t port, std::size_t partner) const;
  std::string misfit(std::size_t port, const PortKernel& kernel) const override;
  /// Completes the reply to an obstacle at the window's end: what friction did.
  void finish(std::size_t port, std::size_t partner, Reaction& reply) const;
  /// [J] by friction with all partners, since the run began.
  double dissipated() const;
  /// [J] on the body and its partners in the substep that was settled last, which nothing pressed
  /// on before, where they overlapped: bodies without inertia take at once what is drawn [M.137].
  /// Of each row's force the half, on the way by which its gap has closed.
  double taken_at_once() const;
  double pressed_in() const { return interference_ ? interference_->work() : 0.0; }  // [J] overlap
  /// At the end of the substep that was settled last.
  SeenGaps seen_gaps() const;

  const std::vector<int>& coordinates() const override { return dofs_; }
  const Vector* solve(double time, const Vector& free, Compliance& give) override;

 private:
  struct Own {  // a surface in its pose
    Surface surface;
    std::vector<int> at;              // (values) its coordinates among those of contact
    std::vector<double> pose, begin;  // [m] (points, dim), and where the substep began
    double travel = 0.0;              // [m] from there that rows are looked for, at most
    double farthest = 0.0;            // [m] the same, to the free pose
    std::size_t met = 0;              // partners that have meetings
    TiedNeighbours neighbours;
  };
  struct Meeting {
    std::unique_ptr<SurfaceObstacle> obstacle;
    std::size_t own = 0;  // of surfaces_
    ContactLaw law;
    std::size_t pressed = 0, reacted = 0;  // where its forces begin in pressed_, reactions_
    std::size_t slid = 0, anchor = 0;      // and its parts of slid_, anchors_, where it rubs
    // Where what sticks has a coefficient of its own, of the window: points that count as sliding
    // because they slid in earlier sweeps, and those that slid in this one (Reaction::slid).
    std::vector<std::int32_t> told_slid, slid_now;
    Eigen::Index first = 0;                  // of its components
    int first_row = 0, rows = 0, parts = 1;  // of the problem; components of a row
  };
  struct OfPoint {  // rows of a point of the port
    int rows = 0;
    double pressed = 0.0;  // [N]
    std::size_t nearest = 0;
  };
  struct Term {  // of a component
    int coordinate;
    double factor;
  };

  class Eased;
  const Vector* solve_rows(double time, const Vector& free, Compliance& give);
  void begin_neighbours(const Window& window);
  std::span<const double> pressing(const Own& own);
  void meet(const Window& window);
  void begin_forces();
  void pose(const Vector& q);
  void make_rows();
  bool find_gaps(const Vector& free);
  void number_touched();
  [[nodiscard]] bool find_compliance(Compliance& give);
  void add_components(Meeting& m);
  void find_terms(const Own& own, const SurfaceRows& rows, int row, const double* direction);
  static double travelled(const Own& own);
  void find_slips(const Meeting& m);
  [[nodiscard]] bool find_forces();
  void number_points();
  [[nodiscard]] bool many(Compliance& give);
  [[nodiscard]] bool find_in_one_matrix(Compliance& give);
  void find_sides();
  [[nodiscard]] bool turn_near_rows();
  [[nodiscard]] bool find_opened(Compliance& give);
  [[nodiscard]] bool find_many(Compliance& give, bool again);
  void tell_missing();
  void guess_forces();
  void begin_slid(Meeting& m, const BoundaryData& boundary, const Substeps& grid);
  void settle_slid(Meeting& m);
  void share_shears(const Meeting& m);
  void settle_friction(std::size_t meeting);
  void settle_interference(std::size_t meeting);
  /// [m] by which the gaps of a meeting are larger than they are, at a time.
  double left_of(const Meeting& m, double time) const {
    return interference_ ? interference_->left(index(&m - meetings_.data()), time) : 0.0;
  }
  void forget_shears(const Meeting& m);
  void spread();
  void begin_looks(double time, const Vector& free);
  void look_from_begin(const Vector& free);
  [[nodiscard]] bool look(const Vector& free, Compliance& give);
  [[nodiscard]] bool move(const Vector& free, Compliance& give);
  std::span<double> pressed(const Meeting& m);
  std::span<double> reacted(const Meeting& m);
  std::span<double> anchor(const Meeting& m);
  std::span<const double> directions(const Meeting& m) const;

  std::vector<Own> surfaces_;
  std::string body_;
  std::optional<Interference> interference_;
  std::vector<int> dofs_;
  struct Sizes {  // of what all meetings so far have in the state
    std::size_t pressed = 0, reacted = 0, slid = 0, shears = 0, anchor = 0;
  } sizes_;
  std::vector<Meeting> meetings_;  // in the order in which partners came
  std::vector<double> pressed_;    // [N] (meetings, values of the port) on the body: state
  std::vector<double> reactions_;  // [N] (meetings, values of the partner) on partners: state
  std::vector<double> turned_;     // (meetings) 1: rows of the partner's nodes: state
  // (meetings that rub, points) what the friction law remembers of the last substep: state
  std::vector<double> slid_;
  // [N] (meetings that rub, values of the port) along the surface, on the body: state
  std::vector<double> shears_;
  std::vector<OfPoint> of_points_;              // of a meeting
  std::vector<double> shares_, shears_before_;  // (rows of a meeting) of what is of a point
  Substeps grid_;                               // of the window
  int substep_ = 0;
  std::vector<double> anchors_;  // [m] (meetings that rub, values of the partner): state
  std::vector<double> anchored_, dissipated_;  // (meetings) 1: anchors are of now; [J]: state
  SeenGaps kept_gaps_;                         // of a state that was saved: state
  bool restored_ = false;  // they are those of now, as the rows are of another state
  int looks_ = 0;          // at the geometry, at this time
  double time_ = 0.0;      // [s] that was solved for last
  // The problem of all rows, by component:
  std::vector<double> directions_, row_gaps_;  // (components, dim) normals and tangents; [m]
  std::vector<FrictionRow> rows_;
  bool rubs_ = false, many_ = false;
  std::vector<std::size_t> first_term_;  // (components + 1)
  std::vector<Term> terms_;
  std::vector<int> touched_, number_;  // coordinates of the terms; (coordinates) theirs, or -1
  Vector along_;                       // [m/N] (touched) by a component's force
  Eigen::MatrixXd compliance_;         // [m/N]
  bool complies_ = false;              // as these components do, with the columns of a version
  std::size_t version_ = 0;
  Vector gaps_, row_force_;  // [m] of the free pose, and slips to there; [N]
  Vector opened_;            // [m] gaps and slips under the forces
  UnilateralBuffers buffers_;
  FrictionBuffers friction_buffers_;
  // Of many rows:
  NearCompliance near_give_;
  std::vector<PressedSide> sides_;
  NearBlocks near_rows_;
  std::vector<std::int32_t> rows_of_near_;  // by their points, for which it was made
  std::vector<double> directions_of_near_;  // and directions
  Vector pressing_, moved_by_;              // [N], [m] (coordinates)
  Vector force_, last_, moved_;             // [N], [N], [m] (coordinates)
  Vector eased_;             // [m] (coordinates) free places, as tied neighbours let them be
  std::vector<double> sum_;  // [N] (values) on a surface
};

}  // namespace abut
