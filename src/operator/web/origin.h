// Which requests come from the page itself. A browser names in Host what its user has typed, and in Origin
// the page that asks: by these two, pages of other sites that are open in the same browser are kept out.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace heel {

/// An IP address, localhost, or one of `names`, each with any port. Another name is one that somebody else
/// has made to lead to this computer (DNS rebinding), or view.hosts is not complete.
bool host_is_ours(std::string_view host, std::span<const std::string> names);

/// The page that asks was loaded from the `host` of the request, by http or https. An empty `origin` (no
/// browser, or a page that the user opens) is none of another site.
bool origin_is_ours(std::string_view origin, std::string_view host);

/// The page that asks was loaded from a host of this name, whatever the port: a viewer that stands elsewhere.
bool origin_is_named(std::string_view origin, std::span<const std::string> names);

}  // namespace heel
