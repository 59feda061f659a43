// SPDX-License-Identifier: GPL-3.0-or-later
#include "page/svg_parts.h"

#include "page/page_parts.h"
#include "text/number_text.h"

// Text instead of a tree of pugixml: most of these parts go into HTML pages, which are text too.
namespace cdprep::report {

std::string units(double value) {
    return fixed(value, 1);
}

std::string line(double x1, double y1, double x2, double y2, const std::string& look) {
    return "<line x1=\"" + units(x1) + "\" y1=\"" + units(y1) + "\" x2=\"" + units(x2) +
           "\" y2=\"" + units(y2) + "\" class=\"" + look + "\"/>\n";
}

std::string words(double x, double y, const std::string& anchor, const std::string& look,
                  const std::string& text) {
    return "<text x=\"" + units(x) + "\" y=\"" + units(y) + "\" text-anchor=\"" + anchor +
           "\" class=\"" + look + "\">" + escaped(text) + "</text>\n";
}

}  // namespace cdprep::report
