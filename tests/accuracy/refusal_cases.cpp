// SPDX-License-Identifier: MIT
// What has to be refused, and boxes that have to hold what they are around: B10's boxes, B14's
// poses, B16's files, T21's coordinates. By the definition of each.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "accuracy/asked_models.h"
#include "accuracy/exact_change.h"
#include "accuracy/hard_cases.h"
#include "support/bvh_boxes.h"
#include "support/reseal.h"

#include "cdprep/format/find_damage.h"
#include "cdprep/format/sections.h"

#ifdef CDPREP_HAVE_TOOLS
#include "unit/tools/soup_of.h"
#include "validate/defects/find_defects.h"
#endif

namespace cdprep::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// In the short form each guise is stored in two of the six ways.
void ask_boxes(const HardMeshes& hard, CaseSize size, Scoreboard& board) {
    std::size_t number = 0;
    for (const ExactChange& change : exact_changes(true)) {
        const auto mesh = change(hard.a);
        if (!mesh) continue;
        const auto told = [&] { return hard.id + ": " + change.name; };
        for (std::size_t i = 0; i < kAllBounds.size(); ++i) {
            for (const build::Quality quality : {build::Quality::best, build::Quality::fast}) {
                const build::Bvh bvh =
                    build::build_bvh(mesh->positions, mesh->triangles,
                                     {.bounds = kAllBounds[i], .quality = quality});
                board.of(hard.id, std::string("boxes/") + kBoundsNames[i])
                    .expect(boxes_hold_all(*mesh, bvh), told);
            }
        }
        ++number;
        for (std::size_t turn = 0; turn < kAllBounds.size(); ++turn) {
            if (size == CaseSize::small && turn % 3 != number % 3) continue;
            const AskedModel asked(*mesh, turn);
            board.of(hard.id, "boxes/deep check")
                .expect(!format::find_deep_damage(asked.bytes()), told);
        }
    }
}

/// Of meshes that stand in several places, each once.
void ask_all_boxes(const HardCaseOptions& options, Scoreboard& board) {
    std::vector<TestMesh> asked;
    for (const HardMeshes& hard : hard_meshes(CaseSize::small)) {
        const bool is_hard = hard.id.starts_with("B10") || hard.id.starts_with("B09") ||
                             hard.id.starts_with("B04") || hard.id.starts_with("F01");
        if (!is_hard || !options.wants(hard.id)) continue;
        const bool is_asked = std::any_of(asked.begin(), asked.end(), [&](const TestMesh& mesh) {
            return mesh.positions == hard.a.positions && mesh.triangles == hard.a.triangles;
        });
        if (is_asked) continue;
        ask_boxes(hard, options.size, board);
        asked.push_back(hard.a);
    }
}

/// Rows of a pose, and whether it is one.
void ask_poses(Scoreboard& board) {
    const auto expect_refused = [&](const std::string& name, const std::array<double, 12>& rows) {
        const auto told = [&] { return "B14 " + name; };
        board.of("B14", "refused/pose").expect(!Pose::from_rows(rows).ok(), told);
        const AskedModel cube(unit_cube(), 1);
        const CModel model(cube.bytes());
        const CWorkspace workspace;
        cdprep_pair pair = in_c(model, model, Placement::b_moves(Pose()));
        std::copy(rows.begin(), rows.end(), std::begin(pair.pose_b.rows));
        cdprep_collision collision{};
        board.of("B14", "refused/C face")
            .expect(cdprep_collide(&pair, workspace.get(), &collision, nullptr) ==
                            CDPREP_BAD_ARGUMENT &&
                        collision.hit == CDPREP_UNKNOWN,
                    told);
    };
    expect_refused("a reflection", {-1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    expect_refused("scale 1.0001", {1.0001, 0, 0, 0, 1.0001, 0, 0, 0, 1.0001, 0, 0, 0});
    expect_refused("a shear", {1, 1e-6, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    expect_refused("no turn at all", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    expect_refused("NaN", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, kNan, 0});
    expect_refused("infinity", {1, 0, 0, 0, 1, 0, 0, 0, 1, kInfinity, 0, 0});
    Tally& quaternions = board.of("B14", "refused/quaternion");
    quaternions.expect(!Pose::from_quaternion(0, 0, 0, 0, {}).ok(), [] { return "B14 zero"; });
    quaternions.expect(!Pose::from_quaternion(kNan, 0, 0, 1, {}).ok(), [] { return "B14 NaN"; });
    for (const double length : {1e-300, 1e300}) {
        const auto half = Pose::from_quaternion(0, 0, 0, length, {});
        bool is_half = half.ok();
        constexpr std::array<double, 9> kHalf = {-1, 0, 0, 0, -1, 0, 0, 0, 1};
        for (std::size_t i = 0; is_half && i < kHalf.size(); ++i) {
            is_half = std::fabs(half.value().rotation()[i] - kHalf[i]) <= Pose::kQuaternionError;
        }
        quaternions.expect(is_half, [] { return "B14 a half turn of any length"; });
    }
}

/// A file of everything, and what is made of it.
class Files {
public:
    explicit Files(Scoreboard& board)
        : board_(board), whole_(AskedModel(icosphere(1), 1).bytes()) {}

    void cut_short(std::size_t step) {
        for (std::size_t size = 0; size < whole_.size(); size += step) {
            expect_refused("truncated", AlignedBytes(bytes().first(size)),
                           std::to_string(size) + " bytes");
        }
    }
    /// Where the flipped bit is padding the file stays what it was; else it is refused.
    void flip_bits(std::size_t step) {
        AlignedBytes changed(bytes());
        Tally& tally = board_.of("B16", "flipped bits");
        for (std::size_t at = 0; at < whole_.size(); at += step) {
            const std::byte bit{static_cast<unsigned char>(1U << at % 8)};
            changed.span()[at] ^= bit;
            const auto opened = Model::open(std::as_const(changed).span());
            const bool is_same = opened && opened.value().header().content_hash == hash();
            tally.expect(!opened || is_same, [&] { return "B16 byte " + std::to_string(at); });
            refused_ += opened ? 0 : 1;
            changed.span()[at] ^= bit;
        }
        tally.expect(refused_ > whole_.size() / step / 2,
                     [] { return "B16 most bits are padding"; });
    }
    /// Checksums made right again: then an answer or a refusal, but never a crash.
    void change_words(std::size_t step) {
        const std::size_t end = std::min<std::size_t>(whole_.size(), 4096);
        Workspace workspace;
        std::vector<TrianglePair> pairs(64);
        for (std::size_t at = 0; at + 4 <= end; at += step) {
            for (const std::uint32_t value : {0U, 1U, 0x7fffffffU, 0xffffffffU, 0x01000000U}) {
                AlignedBytes changed(bytes());
                std::memcpy(changed.span().data() + at, &value, sizeof value);
                reseal(changed.span());
                const auto opened = Model::open(std::as_const(changed).span());
                if (opened && opened.value().bvh().leaves.size() > 0) {
                    (void)overlaps({opened.value(), opened.value(), Placement::b_moves(Pose())},
                                   workspace, pairs);
                }
                board_.of("B16", "header words").expect(true, [] { return ""; });
            }
        }
    }
    /// T21: a coordinate that is none.
    void break_coordinates() {
        for (const double value : {kNan, kInfinity, -kInfinity, 0x1p1023}) {
            AlignedBytes changed(bytes());
            const auto section = format::find_section(bytes(), format::SectionId::positions_f64);
            std::memcpy(changed.span().data() + section->offset + 40, &value, sizeof value);
            reseal(changed.span());
            const auto damage = format::find_damage(std::as_const(changed).span());
            board_.of("T21", "refused/file")
                .expect(damage && damage->kind == format::DamageKind::bad_number,
                        [&] { return "T21 " + std::to_string(value); });
        }
    }

private:
    [[nodiscard]] std::span<const std::byte> bytes() const {
        return whole_.span();
    }
    [[nodiscard]] std::uint64_t hash() const {
        return Model::open(bytes()).value().header().content_hash;
    }
    void expect_refused(const std::string& strategy, const AlignedBytes& file,
                        const std::string& what) {
        const auto opened = Model::open(file.span());
        board_.of("B16", strategy)
            .expect(!opened && opened.error().code == ErrorCode::unreadable,
                    [&] { return "B16 " + what; });
        cdprep_model* model = nullptr;
        board_.of("B16", "C face")
            .expect(cdprep_model_open_memory(file.span().data(), file.size(), nullptr, &model,
                                             nullptr) != CDPREP_OK,
                    [&] { return "B16 " + what; });
    }

    Scoreboard& board_;
    AlignedBytes whole_;
    std::size_t refused_ = 0;
};

#ifdef CDPREP_HAVE_TOOLS
/// The vertex is named, and no other.
void ask_importer(Scoreboard& board) {
    for (const double value : {kNan, kInfinity, -kInfinity}) {
        for (std::uint32_t vertex = 0; vertex < 8; ++vertex) {
            TestMesh cube = unit_cube();
            cube.positions[vertex].y = value;
            const mesh::DefectReport report = mesh::find_defects(soup_of(cube));
            bool is_named = report.counts.non_finite_vertices == 1;
            for (const mesh::Finding& finding : report.findings) {
                if (finding.rule != mesh::Rule::non_finite_coordinate) continue;
                is_named = is_named && finding.places.size() == 1 &&
                           finding.places[0].vertices == std::vector<std::uint32_t>{vertex};
            }
            board.of("T21", "refused/bake").expect(is_named, [&] {
                return "T21 vertex " + std::to_string(vertex);
            });
        }
    }
}
#endif

}  // namespace

void score_refusals(const HardCaseOptions& options, Scoreboard& board) {
    ask_all_boxes(options, board);
    if (options.wants("B14")) ask_poses(board);
    const std::size_t step = options.size == CaseSize::full ? 1 : 7;
    Files files(board);
    if (options.wants("B16")) {
        files.cut_short(step);
        files.flip_bits(step);
        files.change_words(options.size == CaseSize::full ? 4 : 20);
    }
    if (options.wants("T21")) {
        files.break_coordinates();
#ifdef CDPREP_HAVE_TOOLS
        ask_importer(board);
#endif
    }
}

}  // namespace cdprep::test
