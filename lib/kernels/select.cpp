// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <cstring>

#include "cdprep/advanced/query_counts.h"
#include "curve.h"
#include "kernels.h"
#ifdef CDPREP_HAVE_AVX2
#include "processor.h"
#endif

namespace cdprep {

const char* kernel_name() noexcept {
    return kernels::active().name;
}

}  // namespace cdprep

namespace cdprep::kernels {
namespace {

const char* wanted_kernels() noexcept {
#ifdef CDPREP_HAVE_SIMD128
    return nullptr;  // there are no variables, and no choice
#else
    // Read once, before any query; nothing else in the process writes it then.
    return std::getenv("CDPREP_KERNELS");  // NOLINT(concurrency-mt-unsafe)
#endif
}

const Table& choose() noexcept {
    const Available tables = available();
    const char* wanted = wanted_kernels();
    for (std::size_t i = 0; wanted != nullptr && i < tables.count; ++i) {
        if (std::strcmp(tables.table[i]->name, wanted) == 0) return *tables.table[i];
    }
    return *tables.table[tables.count - 1];
}

#ifdef CDPREP_HAVE_AVX2
/// Returns whether BMI2 distributes bits in a few cycles: on Intel, and on AMD from Zen 3 (family
/// 0x19) on. Others are unknown and count as slow.
bool has_fast_bmi2(const Processor& processor) noexcept {
    constexpr unsigned kZen3 = 0x19;
    if (!processor.bmi2) return false;
    return processor.is_intel || (processor.is_amd && processor.family >= kZen3);
}
#endif

const Curve& choose_curve() noexcept {
    const char* wanted = wanted_kernels();
    if (wanted != nullptr && std::strcmp(wanted, kScalarCurve.name) == 0) return kScalarCurve;
#ifdef CDPREP_HAVE_AVX2
    if (has_fast_bmi2(ask_processor())) return kBmi2Curve;
#endif
    return kScalarCurve;
}

}  // namespace

AvailableCurves available_curves() noexcept {
    AvailableCurves curves = {{&kScalarCurve, nullptr}, 1};
#ifdef CDPREP_HAVE_AVX2
    if (ask_processor().bmi2) curves.curve[curves.count++] = &kBmi2Curve;
#endif
    return curves;
}

const Curve& active_curve() noexcept {
    static const Curve& curve = choose_curve();
    return curve;
}

Available available() noexcept {
#ifdef CDPREP_HAVE_SIMD128
    return {{&kSimd128, nullptr, nullptr}, 1};
#else
    Available tables = {{&kScalar, nullptr, nullptr}, 1};
#ifdef CDPREP_HAVE_AVX2
    const Processor processor = ask_processor();
    if (processor.avx2) tables.table[tables.count++] = &kAvx2;
    if (processor.avx512) tables.table[tables.count++] = &kAvx512;
#endif
#ifdef CDPREP_HAVE_NEON
    tables.table[tables.count++] = &kNeon;
#endif
    return tables;
#endif
}

const Table& active() noexcept {
    static const Table& table = choose();
    return table;
}

}  // namespace cdprep::kernels
