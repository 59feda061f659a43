// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

/// The texts from which the page is assembled. The build embeds their files in the program, so
/// that no file is needed at run time.
namespace cdprep::report::page {

extern const std::string_view kFrame;     ///< page.html, with placeholders for the rest: @name@
extern const std::string_view kStyle;     ///< page.css
extern const std::string_view kElements;  ///< elements.js
extern const std::string_view kView;      ///< view.js
extern const std::string_view kList;      ///< list.js
extern const std::string_view kPage;      ///< page.js
extern const std::string_view kLicense;   ///< of three.js
extern const std::string_view kThree;     ///< three.js
extern const std::string_view kControls;  ///< OrbitControls of three.js
extern const std::string_view kTables;    ///< tables.css, of the page of a comparison

}  // namespace cdprep::report::page
