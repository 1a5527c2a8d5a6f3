#pragma once

#include <string>
#include <vector>

#include "subdomain_solver/contact/edged_surface.hpp"
#include "subdomain_solver/contact/near_surface.hpp"
#include "subdomain_solver/interior.hpp"
#include "surface/boxes.hpp"
#include "surface/far_sides.hpp"
#include "surface/meeting_corners.hpp"
#include "surface/mortar.hpp"
#include "surface/point_rows.hpp"

namespace abut {

/// A partner's surface before a port that is a surface: where it lies, how it gives way, and the
/// rows that join the two [M.88].
class SurfaceObstacle {
 public:
  /// `body`: for people.
  SurfaceObstacle(std::size_t port, std::size_t partner, const PortGeometry& own,
                  const Partner& met, std::string body);

  std::size_t port() const { return port_; }
  std::size_t partner() const { return partner_; }
  std::size_t width() const { return met_->surface.points.size(); }
  /// The part of it that contact may be with: its points are those of rows, places and reactions.
  const NearSurface& near() const { return near_; }

  /// Takes what is imposed over a window, which must live until the next, as the partner. `pose`:
  /// [m] (points, dim) where the port is, about; `reaction`: [N] (values of the partner) the force
  /// on the partner now. Throws RunError for what a surface cannot take.
  void impose(const BoundaryData& data, const Partner& met, const Substeps& grid,
              std::span<const double> pose, std::span<const double> reaction);
  /// It acts in this window.
  bool acts() const { return motion_ != nullptr; }
  bool yields() const { return acts() && met_->kernel.count() > 0; }

  /// The substep i is next. `reaction`: [N] (values of the partner) the force on it at the substep
  /// before. `turned`: the rows then were of the partner's nodes.
  void aim(int i, std::span<const double> reaction, bool turned);
  /// Rows are of the nodes of the side with sharp edges there: averaged over facets around an edge,
  /// the other side's would let it through [M.93]. Contact keeps its side, unless an edge comes
  /// near.
  bool turned() const { return turned_; }
  /// Where it lies at a time of this substep without the substep's own reaction.
  void place(double time);
  /// Rows for the port's present pose [m] (points, dim) and its own, to which a reaction [N]
  /// (values of the partner) moves it. What a long substep may lead through each other is still
  /// seen: `travel` [m] is the port's way in it, from the pose at its `begin`.
  void join(std::span<const double> pose, std::span<const double> begin, double travel,
            std::span<const double> reaction);

  const SurfaceRows& rows() const { return rows_; }
  /// [m] (near points, dim) where it lies without the substep's own reaction.
  const std::vector<double>& free() const { return free_; }
  double begin() const { return begin_; }  // [s] of this substep
  /// Where it lay then [m] (near points, dim).
  void find_begin(std::vector<double>& places) const;
  /// Adds the compliance [m/N] among the rows' components, as many of each row as it has
  /// `directions` (components, dim), to a square of `a` that begins at `first`.
  void add_compliance(Eigen::Index first, std::span<const double> directions, Eigen::MatrixXd& a);

  /// Calls `see` with the values of the zone that a component moves along, and how much of each.
  template <class See>  // (std::size_t value, double factor)
  void find_terms(std::span<const double> directions, std::size_t component, const See& see) const;
  /// Where it lies under a reaction [N] (values of the partner) of the substep: [m] (near points,
  /// dim).
  const std::vector<double>& under(std::span<const double> reaction) {
    give_way(reaction);
    return pose_;
  }
  /// How it gives way to this substep's reaction: numbers [m/N] that lie as a step's of the kernel.
  const PortKernel& kernel() const { return met_->kernel; }
  std::span<const double> give() const { return give_; }

  // What rubs is followed by displacements of all its points, as they were predicted: what a window
  // leaves between these and where the partner went would else add up from window to window.
  /// Where slips of the substep that was aimed at begin: at `anchor` [m] (values of the partner)
  /// or, where it is empty, where the partner is then.
  void begin_slip(int i, std::span<const double> anchor);
  const std::vector<double>& slip_begin() const { return slip_begin_; }  // [m] (values of partner)
  /// Where they end under a reaction [N]: the next substep's anchor.
  void end_slip(std::span<const double> reaction, std::span<double> anchor);

 private:
  void find_near(std::span<const double> pose, std::span<const double> reaction, bool grows);
  void find_zone();
  void find_travel(int i);
  void give_way(std::span<const double> reaction);
  void choose_side(std::span<const double> pose);
  bool corners_may_meet() const { return wedges_.any() && own_wedges_.any(); }
  void find_pose_before();
  void leave_out_far_sides(const PosedSurface& k, std::span<const double> begin,
                           const PosedSurface& n, double way);
  void join_averages(const PosedSurface& k, std::span<const double> begin, const PosedSurface& n,
                     double way);
  void join_points(const PosedSurface& own, const PosedSurface& other);
  void recall(int level, double share);
  void find_give(int level, double share);
  void lean(int level, double share);

  std::size_t port_, partner_;
  const PortGeometry& own_;
  const Partner* met_;
  std::string body_;
  MortarOptions options_;
  double reach_ = 0.0, travel_ = 0.0;  // [m] of a substep of no length; own way in this one
  EdgedSurface edges_, own_edges_;
  Wedges wedges_, own_wedges_;
  FarSides far_sides_;
  MeetingCorners corners_;
  NearSurface near_;
  std::vector<std::int32_t> needed_;    // points that are to be in it
  double time_ = 0.0, begin_ = 0.0;     // [s] that it was placed for; the substep's begin
  bool turned_ = false;                 // rows are of the partner's nodes
  bool chosen_ = false, held_ = false;  // in this substep; it pressed in the one before
  const Waveform* motion_ = nullptr;
  Substeps grid_;
  bool leans_ = false;  // its levels are not the substeps, and a part of it follows every instant
  // While it yields, of the window: its own levels (l), the substeps' levels (s).
  std::vector<double> parts_;   // (l, s) of the reactions that its levels take
  std::vector<double> later_;   // (l) of this substep's reaction, held to the window's end
  std::vector<double> taken_;   // [N] (l, zone) of earlier ones, beyond what d was found under
  std::vector<double> memory_;  // [m] (zone) of earlier reactions, at the substep's end
  std::vector<double> give_;    // [m/N] to this substep's reaction, as a step's of the kernel
  std::vector<double> leaning_, moved_;        // [N], [m] (zone)
  std::vector<std::int32_t> zone_points_;      // of the partner
  std::vector<std::size_t> zone_, zone_near_;  // values that give way, of the partner, of the near
  std::vector<int> in_zone_;                   // (near values) where in the zone; -1: they do not
  std::vector<double> free_, pose_;            // [m] (near points, dim)
  std::vector<double> pose_before_;            // the same, when the substep began
  std::vector<double> given_, before_;         // [m] (values) displacements
  std::vector<double> slip_begin_;             // [m] (values of the partner)
  BoxTree tree_, own_tree_;                    // the port's with the reach around its boxes
  std::vector<double> fitted_;  // [m] (near points, dim) pose of tree_; empty: of none
  std::vector<FacetPair> pairs_, averaged_;
  MortarBuffers buffers_;
  std::vector<std::int32_t> own_nodes_;  // where rows are of single points
  PointRowBuffers point_buffers_;
  SurfaceRows rows_;
  std::vector<double> answer_;  // [m/N] (zone) of the surface to a row
};

template <class See>
void SurfaceObstacle::find_terms(std::span<const double> directions, std::size_t component,
                                 const See& see) const {
  const std::size_t dim = index(rows_.dim), parts = directions.size() / dim / index(rows_.count());
  const std::size_t row = component / parts;
  for (std::int32_t e = rows_.n.offsets[row]; e < rows_.n.offsets[row + 1]; ++e) {
    const int begin = in_zone_[index(rows_.n.columns[e]) * dim];
    for (std::size_t d = 0; begin >= 0 && d < dim; ++d)
      if (const double part = directions[component * dim + d]; part != 0.0)
        see(index(begin) + d, rows_.n.values[e] * part);
  }
}

}  // namespace abut
