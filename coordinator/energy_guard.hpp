#pragma once

#include <span>
#include <vector>

#include "base/archive.hpp"
#include "contract/subdomain.hpp"

namespace abut {

/// Watches the bodies' energy, what became heat included, less the work of external loads.
/// Supports, ties and contact make none, so it must not grow; that it does is how an unstable step
/// or window shows itself before its numbers overflow  [M.21]. A body that says that it conserves
/// energy is watched by itself: what its ports did is known, so it may neither gain nor lose.
class EnergyGuard {
 public:
  enum class Verdict { fine, warn, fail };

  /// How a body steps. Of one without inertia: none.
  struct Stepping {
    double mass = 0.0;  // [kg]
    double step = 0.0;  // [s]
  };

  /// `share`: change, as a fraction of the largest kinetic and stored energy so far, that fails.
  /// `conserves`: by body, whether it is watched by itself; all: whether losses are wrong too.
  /// `together`: whether the sum of all bodies is watched. `stepping`: by body; empty: not told.
  /// Bodies that rest when loads set in have no energy that steps resolve: the first ten looks are
  /// not judged, and it counts as if there had been in motion what steps do not resolve, and what
  /// places of bodies are rounded by  [M.21].
  EnergyGuard(double share, std::vector<bool> conserves, bool together = true,
              std::vector<Stepping> stepping = {});

  /// Looks at the last record of every body, once for every accepted window. Warns once, at half
  /// the share of growth; of losses at the share itself.
  /// `struck` [J]: by body, what records hold already and the ports' work does not yet; empty:
  /// none.
  Verdict look(std::span<const Response> responses, std::span<const double> struck = {});
  /// Whether a window that was tried, where it can be gone another way, gains too much: beyond a
  /// two-hundredth above the start (a tenth of the share, where that is more), or by half the share
  /// at once [M.21]. Changes nothing.
  bool refuses(std::span<const Response> responses, std::span<const double> struck = {}) const;
  /// Whether contact, which takes so much [J] in such a window, takes too much: all bodies together
  /// have lost more by it than four times that share of the largest energy, or of the work of
  /// loads and tools on a body, which contact passes on  [M.21]. Changes nothing.
  bool loses(std::span<const Response> responses, double to_contact,
             std::span<const double> struck = {}) const;
  /// The same of a flight, at the end of each of its windows, `window` records apart: what is made
  /// and damped away within it counts as well, and how windows are joined changes nothing.
  bool refuses_flight(std::span<const Response> responses, int window) const;
  /// Whether all bodies together would end the run, if they were paid so much [J]. Changes nothing.
  bool ends(std::span<const Response> responses, double payments) const;
  /// [J] by which the energy is above its start, beyond what may stand there: less than a tenth of
  /// the share of the largest, and of what loads and supports have worked on a body [M.21].
  /// Asked of windows in which surfaces touch and of no others: how windows without contact are
  /// joined, which output decides, then changes no result.
  /// `payments` [J]: what contact of bars would pay them beside.
  double excess(std::span<const Response> responses, std::span<const double> struck = {},
                double payments = 0.0);
  /// [J] by which all energies have grown beyond a two-hundredth of the largest (a tenth of the
  /// share, where that is more), early looks included: what windows have made that were let pass.
  double overgrown(std::span<const Response> responses) const;
  /// [J] of that excess which may stay where bodies have nothing to repay it with.
  double forgiven() const;
  /// So much [J] of what was gained a body has given back since: what accounts say takes it in.
  void repaid(int body, double joules);
  /// Responses to impulses alone, which the last look has seen already.
  void struck(std::span<const Response> responses);
  /// [J] by which all energies have changed until the last look, and one body's where neither ports
  /// nor loads explain it; 0 where the sum over all bodies is not watched.
  double change() const { return begun_ && together_ ? latest_ - first_ : 0.0; }
  double unexplained(int body) const;
  double growth() const { return growth_; }  // as a fraction, at the last look
  double most() const { return most_; }      // [J] largest kinetic and stored energy so far
  void state(Archive& archive);
  int culprit() const { return culprit_; }  // body that a verdict is about; -1: all together

 private:
  struct Account {
    double first = 0.0;   // [J] its own energy at the first look
    double ports = 0.0;   // [J] done on it through its ports since
    double change = 0.0;  // [J] that nothing explains
    void state(Archive& archive);
  };

  double bound() const;
  double own_energy(std::span<const Response> responses, std::size_t before_end,
                    double& motion) const;
  double own_energy(std::span<const Response> responses, std::span<const double> struck,
                    double& motion) const;
  bool gains(std::span<const Response> responses, double own, double more, double motion) const;
  double unresolved(std::span<const Response> responses) const;
  double rounding(std::span<const Response> responses) const;
  Verdict verdict(double change, double share, bool losses);

  double share_;
  std::vector<bool> conserves_;
  std::vector<Stepping> stepping_;
  bool all_conserve_, together_;
  bool begun_ = false, warned_ = false;
  int unjudged_ = 0;  // looks that are still not judged
  std::vector<Account> bodies_;
  double first_ = 0.0;   // [J] at the first look
  double latest_ = 0.0;  // [J] at the latest look
  double most_ = 0.0;    // [J] largest kinetic and stored energy so far, or what numbers resolve
  double repaid_ = 0.0;         // [J] by all bodies
  double most_touching_ = 0.0;  // [J] largest energy, or work, at the start and in contact
  double growth_ = 0.0;
  int culprit_ = -1;
};

}  // namespace abut
