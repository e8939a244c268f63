#pragma once

#include <string>
#include <string_view>

namespace pendular::viz {

/// Text as it may stand anywhere in an HTML page.
std::string escaped(std::string_view text);

/// RFC 4648, section 4.
std::string base64(std::string_view bytes);

/// A relative path as it may stand in a link: what is neither letter, digit nor one of "-._~/" is
/// percent-coded.
std::string link_to(std::string_view path);

/// What a Content-Security-Policy calls an inline script or style: 'sha256-…' of its text.
std::string policy_hash(std::string_view text);

}  // namespace pendular::viz
