// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/accuracy.h"
#include "accuracy/accuracy_chart.h"
#include "accuracy/accuracy_report.h"
#include "cdprep/format/file_header.h"
#include "cli/command.h"
#include "cli/import_arguments.h"
#include "cli/load_mesh.h"
#include "cli/open_for.h"
#include "cli/output_path.h"
#include "cli/program_threads.h"
#include "cli/progress.h"
#include "cli/report_output.h"
#include "cli/signals.h"
#include "command_line/command_line.h"
#include "command_line/command_page.h"
#include "mesh/weld.h"
#include "study/memory_model.h"

namespace cdprep::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Arguments {
    fs::path a;
    fs::path b;
    fs::path output;
    std::vector<fs::path> saves;  ///< more files; the extension gives the format
    bool is_quick = false;
    std::uint64_t seed = 1;
    std::vector<std::string> ladders;
    std::string format = "text";
    std::string progress = "auto";
    std::size_t threads = 0;
    LoadOptions load;
    ImportArguments import;
};

/// Shows the progress of the study and an estimate of the remaining time.
class Teller {
public:
    explicit Teller(Progress& progress) : progress_(progress) {}

    void tell(double share, const std::string& step) {
        const double passed = std::chrono::duration<double>(Clock::now() - begun_).count();
        std::string what = step;
        if (share >= kFirstEstimate) {
            const double left = std::ceil(passed * (1 - share) / share);
            what += ", about " + std::to_string(static_cast<long>(left)) + " s left";
        }
        progress_.show(static_cast<std::size_t>(100 * share), what);
    }

private:
    static constexpr double kFirstEstimate = 0.02;

    Progress& progress_;
    Clock::time_point begun_ = Clock::now();
};

constexpr std::array<const char*, 5> kFormats = {"text", "json", "csv", "svg", "html"};

/// One destination of the report.
struct Output {
    std::string format;
    ReportOutput to;
};

/// Returns the format that the extension of a file name selects.
Result<std::string> format_of(const fs::path& path) {
    std::string end = path.extension().string();
    if (!end.empty()) end.erase(0, 1);
    if (end == "txt") return std::string("text");
    if (end != "text" && std::ranges::count(kFormats, end) > 0) return end;
    return Error{ErrorCode::bad_argument,
                 path.string() + ": the extension must be .txt, .json, .csv, .svg or .html."};
}

/// Opens all files, so that an unwritable path fails before the work.
Result<std::vector<Output>> open_outputs(const Arguments& arguments) {
    std::vector<std::pair<std::string, fs::path>> wanted = {{arguments.format, arguments.output}};
    for (const fs::path& path : arguments.saves) {
        const Result<std::string> format = format_of(path);
        if (!format) return format.error();
        wanted.emplace_back(format.value(), path);
    }
    UsedFiles used;
    used.add_input(arguments.a);
    used.add_input(arguments.b);
    std::vector<Output> outputs;
    for (const auto& [format, path] : wanted) {
        if (const Result<Done> added = used.add_output(path); !added) return added.error();
        Result<ReportOutput> opened = ReportOutput::open(path);
        if (!opened) return opened.error();
        outputs.push_back({format, std::move(opened).value()});
    }
    return outputs;
}

bool is_baked(const fs::path& input) {
    std::ifstream file(input, std::ios::binary);
    std::array<char, format::kMagic.size()> begin{};
    file.read(begin.data(), begin.size());
    return file && begin == format::kMagic;
}

struct LoadedMesh {
    mesh::Mesh mesh;
    double metres_per_unit = 0;  ///< 0: unknown
};

/// Returns the mesh of a mesh file as bake makes it, or the mesh of a baked file as it was baked.
/// The first bytes decide which kind the file is. Shows that it is read. Fails with bad_argument if
/// a baked file has no triangles or positions, or if the options ask to normalize or weld it.
Result<LoadedMesh> load_for_study(const fs::path& input, const LoadOptions& options,
                                  Progress& progress) {
    const bool is_mesh_file = !is_baked(input);
    progress.show(0, input.filename().string() + ": read");
    if (is_mesh_file) {
        const Result<mesh::TriangleSoup> soup = load_soup(input, options);
        if (!soup) return soup.error();
        return LoadedMesh{mesh::weld(soup.value(), {options.weld_distance}).mesh,
                          soup->metres_per_unit};
    }
    if (options.normalize || options.weld_distance > 0) {
        return Error{ErrorCode::bad_argument,
                     input.string() +
                         ": is a baked file; --normalize and --weld apply to mesh files. Remove "
                         "them, or give the mesh file."};
    }
    const Result<Model> model = open_for(input, Ask::corners);
    if (!model) return model.error();
    return LoadedMesh{study::mesh_of(model.value()), unit_of(model.value())};
}

Result<study::AccuracyStudy> study_pair(const Arguments& arguments, Progress& progress) {
    const Threads threads(arguments.threads);
    LoadOptions load = arguments.load;
    std::vector<fs::path> outputs = arguments.saves;
    outputs.push_back(arguments.output);
    load.import = arguments.import.options(outputs);
    load.import.parallel_for = threads.parallel_for();
    const Result<LoadedMesh> a = load_for_study(arguments.a, load, progress);
    if (!a) return a.error();
    if (is_interrupted()) return interrupted(arguments.a);
    const Result<LoadedMesh> b = load_for_study(arguments.b, load, progress);
    if (!b) return b.error();
    if (is_interrupted()) return interrupted(arguments.b);
    if (const auto unlike =
            find_unlike_units(arguments.a, a->metres_per_unit, arguments.b, b->metres_per_unit)) {
        return *unlike;
    }

    Teller teller(progress);
    Result<study::AccuracyStudy> studied = study::study_accuracy(
        a->mesh, b->mesh,
        {.is_quick = arguments.is_quick,
         .seed = arguments.seed,
         .ladders = arguments.ladders,
         .parallel_for = threads.parallel_for(),
         .stop = is_interrupted,
         .progress = [&](double share, const std::string& step) { teller.tell(share, step); }});
    if (studied || studied.error().code != ErrorCode::bad_argument) return studied;
    return Error{ErrorCode::bad_argument, arguments.a.string() + ", " + arguments.b.string() +
                                              ": " + studied.error().message};
}

std::string written_as(const std::string& format, const report::AccuracyReport& report) {
    if (format == "json") return report::accuracy_json(report);
    if (format == "csv") return report::accuracy_csv(report);
    if (format == "svg") return report::accuracy_svg(report);
    if (format == "html") return report::accuracy_page(report);
    return report::accuracy_text(report);
}

/// Writes the report to all outputs. Prints an error for each output that fails.
Exit write(const report::AccuracyReport& report, std::vector<Output>& outputs) {
    for (Output& output : outputs) {
        const std::string text = written_as(output.format, report);
        Result<Done> written = output.to.append(text);
        if (written) written = output.to.finish();
        if (!written) return fail("accuracy", written.error());
    }
    for (const std::string& sentence : report.study.broken) {
        std::cerr << "cdprep accuracy: a promise is broken: " << sentence << '\n';
    }
    return static_cast<Exit>(report.exit);
}

Exit run(const Arguments& arguments) {
    Progress progress(parse_progress(arguments.progress), 100);
    Result<std::vector<Output>> outputs = open_outputs(arguments);
    if (!outputs) return fail("accuracy", outputs.error());
    Result<study::AccuracyStudy> studied = study_pair(arguments, progress);
    progress.clear();
    report::AccuracyReport report;
    report.input = arguments.a.string();
    report.input_b = arguments.b.string();
    report.version = CDPREP_VERSION;
    if (!studied) {
        if (arguments.format == "json" && arguments.output.empty()) {
            report.exit = static_cast<int>(exit_for(studied.error().code));
            report.error = studied.error().message;
            std::cout << report::accuracy_json(report);
        }
        return fail("accuracy", studied.error());
    }
    report.study = std::move(studied).value();
    if (!report.study.broken.empty()) report.exit = static_cast<int>(Exit::internal);
    return write(report, outputs.value());
}

}  // namespace

void add_accuracy(const Command& app, Exit& exit) {
    auto arguments = std::make_shared<Arguments>();
    const Command command = app.add_command("accuracy", "Measure what accuracy costs in time");
    command.set_notes(
        "The command answers the same queries about A and B by several methods, from coarse to "
        "exact. The poses are seeded, and their exact answers are known. The report has the time, "
        "size and errors of each method. The exit code is 6 if a method breaks its promise. An "
        "example is an enclosing shape that misses a contact, or an interval without the distance. "
        "Queries run on one thread; --jobs applies to building the structures.",
        {"cdprep accuracy arm.obj part.obj --quick",
         "cdprep accuracy arm.obj part.obj --format html -o cost.html"});
    command.add_option("A", arguments->a, "The model that does not move: a mesh or a baked file")
        .required();
    command.add_option("B", arguments->b, "The model that moves: a mesh or a baked file")
        .required();
    command.add_option("-o,--output", arguments->output, "The report. Default: standard output")
        .type_name("FILE")
        .group("Report");
    command
        .add_option("--save", arguments->saves,
                    "Also write this file: .txt, .json, .csv, .svg or .html. May be repeated")
        .type_name("FILE")
        .one_value_each()
        .group("Report");
    command.add_option("--format", arguments->format, "Format of the report")
        .type_name("FORMAT")
        .check(one_of(std::vector<std::string>(kFormats.begin(), kFormats.end())))
        .show_default()
        .group("Report");
    command
        .add_flag("--quick", arguments->is_quick,
                  "Use fewer poses, rounds and methods: takes seconds instead of one or two "
                  "minutes")
        .group("Study");
    command.add_option("--seed", arguments->seed, "Seed of the poses")
        .check(whole_from(0))
        .show_default()
        .group("Study");
    command
        .add_option("--ladder", arguments->ladders,
                    "Comma-separated ladders, each a series of methods from coarse to fine. "
                    "Default: all")
        .type_name("LIST")
        .delimiter(',')
        .check(one_of(
            std::vector<std::string>(study::kLadderNames.begin(), study::kLadderNames.end())))
        .group("Study");
    add_normalize(command, arguments->load.normalize);
    add_weld(command, arguments->load.weld_distance);
    add_jobs(command, arguments->threads);
    add_progress(command, arguments->progress);
    add_import_arguments(command, arguments->import);
    command.callback([arguments, &exit] { exit = run(*arguments); });
}

}  // namespace cdprep::cli
