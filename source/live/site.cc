// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/page_files.h>
#include <exemplar/live/site.h>

namespace Exemplar::Live
{
  namespace http = boost::beast::http;

  namespace
  {
    std::string_view
    path_of(const Request &request)
    {
      const auto target = request.target();
      return { target.data(), std::min(target.find('?'), target.size()) };
    }

    std::string
    value_of(const Request &request, const http::field field)
    {
      const auto value = request[field];
      return { value.data(), value.size() };
    }

    /// The Content-Security-Policy: scripts and styles come from this server alone, and the page
    /// connects to no other.
    std::string
    content_policy(const std::string &host, const std::string &sources)
    {
      return "default-src 'none'; " + sources
             + "; img-src 'self' data:; "
               "connect-src 'self' ws://"
             + host + " wss://" + host
             + "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
    }

    Response
    text_response(const Request &request, const http::status status, const std::string &text)
    {
      Response response(status, request.version());
      response.set(http::field::content_type, "text/plain; charset=utf-8");
      response.body() = text;
      return response;
    }

    Response
    redirect_with_cookie(const Request &request, const Access &access)
    {
      Response response = text_response(request, http::status::see_other, "");
      response.set(http::field::location, "./"); // address without the token
      response.set(http::field::set_cookie, access.cookie_to_set());
      return response;
    }

    Response
    file_response(const Request &request, const Site::File &file, const std::string &host)
    {
      Response response(http::status::ok, request.version());
      response.set(http::field::content_type, file.type);
      response.set("Content-Security-Policy", content_policy(host, file.sources));
      response.body() = file.bytes;
      return response;
    }

    Response
    answer_without_head(const Request     &request,
                        const Access      &access,
                        const Site        &site,
                        const std::string &objection)
    {
      if (!objection.empty())
        return text_response(request, http::status::forbidden,
                             "Open the address that exemplar live has printed.\n");
      if (request.method() != http::verb::get && request.method() != http::verb::head)
        return text_response(request, http::status::method_not_allowed, "Only GET.\n");
      if (path_of(request) == "/"
          && access.is_token(
              value_in_query({ request.target().data(), request.target().size() }, "token")))
        return redirect_with_cookie(request, access);
      const Site::File *file = site.find(std::string(path_of(request)));
      if (file == nullptr)
        return text_response(request, http::status::not_found, "There is no such page.\n");
      return file_response(request, *file, value_of(request, http::field::host));
    }
  } // namespace

  Site::Site() : is_live(true)
  {
    const std::string own = "script-src 'self'; style-src 'self'";
    const auto add = [&](const std::string &path, const std::string &type, std::string bytes) {
      files[path] = { type + "; charset=utf-8", std::move(bytes), own };
    };
    add("/", "text/html", page_file("index.html"));
    add("/style.css", "text/css", page_file("style.css"));
    for (const std::string name :
         { "app.js", "view.js", "body.js", "camera.js", "ground.js", "marks.js", "outline.js",
           "messages.js", "motion.js", "obstacles.js", "skin.js", "latest.js", "pointer.js",
           "panel.js", "sliders.js", "weights.js", "words.js" })
      add("/" + name, "text/javascript", page_file(name));
    for (const std::string name :
         { "build/three.module.js", "examples/jsm/controls/OrbitControls.js" })
      add("/three/" + name, "text/javascript", three_file(name));
  }

  void
  Site::set_surface(const std::string &bytes)
  {
    if (!bytes.empty())
      files["/surface.bin"] = { "application/octet-stream", bytes, "script-src 'none'" };
  }

  Site::Site(std::string page) : is_live(false)
  {
    files["/"] = { "text/html; charset=utf-8", std::move(page),
                   "script-src 'unsafe-inline'; style-src 'unsafe-inline'" };
  }

  const Site::File *
  Site::find(const std::string &path) const
  {
    const auto file = files.find(path);
    return file == files.end() ? nullptr : &file->second;
  }

  std::string
  objection_to(const Request &request, const Access &access)
  {
    const std::string host = value_of(request, http::field::host);
    if (request.count(http::field::host) != 1 || !access.knows_host(host))
      return "host " + host;
    const bool is_socket = path_of(request) == "/ws";
    if ((is_socket || request.count(http::field::origin) > 0)
        && (request.count(http::field::origin) != 1
            || !Access::is_own_origin(value_of(request, http::field::origin), host)))
      return "origin " + value_of(request, http::field::origin);
    const auto target = request.target();
    const auto token  = value_in_query({ target.data(), target.size() }, "token");
    if (!token.empty() && path_of(request) == "/")
      return access.is_token(token) ? "" : "a wrong token";
    return access.has_cookie(value_of(request, http::field::cookie)) ? "" : "no cookie";
  }

  Response
  answer(const Request     &request,
         const Access      &access,
         const Site        &site,
         const std::string &objection)
  {
    Response response = answer_without_head(request, access, site, objection);
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    response.keep_alive(request.keep_alive() && objection.empty());
    response.prepare_payload();
    if (request.method() == http::verb::head)
      response.body().clear();
    return response;
  }
} // namespace Exemplar::Live
