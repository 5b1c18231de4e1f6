// The answers to the requests that browsers and monitoring make, without the network: docs/page.md.
#pragma once

#include <string>
#include <string_view>

#include "operator/settings.h"
#include "operator/web/live_hub.h"
#include "operator/web/page_files.h"
#include "operator/web/view_facts.h"
#include "telemetry/telemetry.h"

namespace heel {

struct PageRequest {
  std::string_view method;                    ///< "GET"
  std::string_view target;                    ///< "/api/log?n=20"
  std::string_view host, origin, fetch_site;  ///< headers; empty: not sent
};

struct PageAnswer {
  unsigned status = 200;
  std::string_view media_type = "application/json";
  std::string body;
  bool is_page = false;      ///< a file of the page, which browsers may keep when they ask whether it is new
  std::string_view allow{};  ///< with 405: the method that is served
};

PageAnswer page_error(unsigned status, const std::string& error);

class HttpAnswers {
 public:
  /// Everything is borrowed.
  struct Sources {
    const Settings& settings;
    const Telemetry& telemetry;
    LiveFeed& feed;
    const LiveHub& hub;
    RecentLog& log;
    const ViewFacts& facts;
  };
  HttpAnswers(const Sources& sources, PageFiles files, bool has_token)
      : sources_(sources), files_(std::move(files)), has_token_(has_token) {}

  /// Why a request is refused by its Host, its Origin, or the page that makes it; status 200: it is not.
  PageAnswer check_site(const PageRequest& request) const;
  /// A request that was not refused; all but POST /estop.
  PageAnswer answer(const PageRequest& request) const;

 private:
  std::string info() const;
  std::string log(std::string_view query) const;

  const Sources sources_;
  const PageFiles files_;
  const bool has_token_;
};

}  // namespace heel
