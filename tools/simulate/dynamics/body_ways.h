// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "cdprep/model.h"
#include "cdprep/motion.h"
#include "cdprep/pairs.h"
#include "cdprep/result.h"

namespace cdprep::dynamics {

/// How a body moves in a substep, from time 0 to time 1.
struct BodyWay {
    const Model* model = nullptr;
    std::vector<Motion> motions;  ///< one after the other, of equal times
    Double3 centre{};             ///< of the body, in model coordinates
    double radius = 0;            ///< no point of the model is farther from the centre
    bool is_continuous = false;
    bool is_free = false;  ///< it ends where it meets a continuous body; others go on
};

/// Two bodies that meet, of which `body` is continuous.
struct WayImpact {
    std::uint32_t body;
    std::uint32_t other;
    double time;
};

/// Ways that bodies go at the same time. Nothing passes through a continuous body. Where such a
/// body and another one meet first, both end their ways if they are free. A body that is not free
/// goes on and takes the other one along, until a third one does not give way.
class BodyWays {
public:
    /// `are_paired` says whether two bodies push each other. Their models must serve Ask::distance.
    /// Impacts are found as exactly as `tolerance`. The workspace must outlive the object.
    BodyWays(std::span<const BodyWay> ways,
             std::function<bool(std::uint32_t, std::uint32_t)> are_paired, Workspace& workspace,
             double tolerance);

    /// Finds the impacts in the order of their times, and ends the ways there. Bodies that touch at
    /// time 0 do not meet: they have contacts. Fails with bad_argument if a body leaves the range
    /// of coordinates.
    [[nodiscard]] Result<Done> run();

    [[nodiscard]] std::span<const WayImpact> impacts() const noexcept {
        return impacts_;
    }
    /// Returns where a body is at time 1, if its way has ended elsewhere.
    [[nodiscard]] std::optional<Pose> changed_end(std::uint32_t body) const;

private:
    enum class Phase : std::uint8_t {
        going,    ///< as its way says
        stopped,  ///< at a body
        carried,  ///< by a body that is not free
        squeezed  ///< between that one and another
    };
    /// What a body does where it meets another one.
    enum class Role : std::uint8_t { stays, yields, drives };
    struct Body {
        BodyWay way;  ///< its motions go from `begin` to time 1
        double begin = 0;
        Phase phase = Phase::going;
        std::uint32_t carrier = 0;  ///< if carried
    };
    struct Meeting {
        double time;
        std::uint32_t a;
        std::uint32_t b;  ///< a < b
    };

    [[nodiscard]] bool moves(std::uint32_t body) const;
    [[nodiscard]] Role role_of(std::uint32_t body) const;
    [[nodiscard]] bool may_meet(std::uint32_t a, std::uint32_t b) const;
    [[nodiscard]] double next_motion(std::uint32_t body, double time) const;
    [[nodiscard]] Result<Motion> motion_in(std::uint32_t body, double from, double to) const;
    [[nodiscard]] Result<Done> find_meeting(std::uint32_t a, std::uint32_t b, double from);
    [[nodiscard]] Result<Done> find_again(std::uint32_t body, double from);
    [[nodiscard]] Result<Done> meet(const Meeting& meeting);
    [[nodiscard]] Result<bool> change(std::uint32_t body, Role own, std::uint32_t other, Role met,
                                      double time);
    [[nodiscard]] Result<bool> stop(std::uint32_t body, double time, Phase phase);
    [[nodiscard]] Result<bool> carry(std::uint32_t body, std::uint32_t carrier, double time);

    std::vector<Body> bodies_;
    std::function<bool(std::uint32_t, std::uint32_t)> are_paired_;
    Workspace& workspace_;
    double tolerance_;
    std::vector<Meeting> meetings_;
    std::set<std::pair<std::uint32_t, std::uint32_t>>
        left_out_;  ///< pairs, the smaller number first
    std::vector<WayImpact> impacts_;
};

}  // namespace cdprep::dynamics
