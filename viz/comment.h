#pragma once

#include <string>

namespace pendular::viz {

/// The bytes of a picture with a comment in its metadata, and without what differs from one drawing of the
/// same picture to the next. PNG: a text chunk "Comment". PDF: the document's subject. SVG: its description.
/// The bytes are as gnuplot (cairo) writes them.
std::string png_with_comment(std::string png, const std::string& comment);
std::string pdf_with_comment(std::string pdf, const std::string& comment);
std::string svg_with_comment(std::string svg, const std::string& comment);

}  // namespace pendular::viz
