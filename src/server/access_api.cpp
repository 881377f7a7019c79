// SPDX-License-Identifier: MIT
#include "server/access_api.h"

#include <nlohmann/json.hpp>

#include "server/body_fields.h"

namespace dynslam {
namespace {

using nlohmann::json;

HttpAnswer with_json(int status, const json& message) {
  HttpAnswer answer;
  answer.status = status;
  answer.body = message.dump(-1, ' ', false, json::error_handler_t::replace);
  return answer;
}

HttpAnswer refusal_of(const Admission& admission) {
  HttpAnswer answer = error_answer(admission.status, admission.why);
  if (admission.retry_after_s > 0)
    answer.headers.emplace_back("Retry-After", std::to_string(admission.retry_after_s));
  return answer;
}

json credential_json(const Credential& c) {
  return {{"id", c.id},
          {"kind", c.kind == Credential::Kind::kToken ? "token" : "session"},
          {"name", c.name},
          {"role", to_string(c.role)},
          {"created", c.created.time_since_epoch().count()},
          {"last_seen", c.last_seen.time_since_epoch().count()}};
}

/// The role that a request gives to somebody.
std::optional<Role> role_in(BodyFields& body) { return role_named(body.text("role")); }

constexpr const char* kRoles = "role must be viewer, driver or admin";

}  // namespace

void AccessApi::add_to(RouteTable& routes) {
  add(routes, "POST", "/api/v1/pair", Role::kNone, &AccessApi::pair);
  add(routes, "GET", "/api/v1/me", Role::kNone, &AccessApi::me);
  add(routes, "POST", "/api/v1/logout", Role::kViewer, &AccessApi::logout);
  add(routes, "GET", "/api/v1/people", Role::kAdmin, &AccessApi::people);
  add(routes, "POST", "/api/v1/invitations", Role::kAdmin, &AccessApi::invite);
  add(routes, "POST", "/api/v1/tokens", Role::kAdmin, &AccessApi::make_token);
  add(routes, "DELETE", "/api/v1/people/{}", Role::kAdmin, &AccessApi::revoke);
}

void AccessApi::add(RouteTable& routes, const char* method, const char* path, Role needed, Handler handler) {
  routes.add(method, path, [this, needed, handler](const HttpRequest& request, const std::string& name) {
    const Gate::Decision decision = gate_.admit(request, needed);
    return decision.refusal ? *decision.refusal : (this->*handler)(request, decision.visitor, name);
  });
}

HttpAnswer AccessApi::pair(const HttpRequest& request, const Visitor&, const std::string&) {
  BodyFields body(request);
  const std::string code = body.text("code"), name = body.text("name");
  if (const auto problem = body.problem()) return *problem;
  const Admission admission = access_.pair(code, name, request.address, AccessTime::now());
  if (admission.status != 200) return refusal_of(admission);
  HttpAnswer answer =
      with_json(200, {{"name", admission.credential.name}, {"role", to_string(admission.credential.role)}});
  answer.headers.emplace_back("Set-Cookie", admission.set_cookie);
  return answer;
}

HttpAnswer AccessApi::me(const HttpRequest&, const Visitor& visitor, const std::string&) {
  return with_json(200, {{"name", visitor.name}, {"role", to_string(visitor.role)}});
}

HttpAnswer AccessApi::logout(const HttpRequest&, const Visitor& visitor, const std::string&) {
  const Judgement done = access_.revoke(visitor.id);
  HttpAnswer answer;
  answer.status = 204;
  if (done.status == 500) answer = error_answer(500, done.why);
  answer.headers.emplace_back("Set-Cookie", Access::clearing_cookie());
  return answer;
}

HttpAnswer AccessApi::people(const HttpRequest&, const Visitor&, const std::string&) {
  json all = json::array();
  for (const Credential& c : access_.credentials(AccessTime::now())) all.push_back(credential_json(c));
  return with_json(200, {{"people", all}});
}

HttpAnswer AccessApi::invite(const HttpRequest& request, const Visitor&, const std::string&) {
  BodyFields body(request);
  const auto role = role_in(body);
  if (const auto problem = body.problem()) return *problem;
  if (!role) return error_answer(422, kRoles);
  const AccessTime now = AccessTime::now();
  const PairingCode code = access_.invite(*role, now);
  const auto lasts = std::chrono::duration_cast<std::chrono::seconds>(code.expires - now.steady);
  return with_json(201, {{"code", code.text}, {"role", to_string(*role)}, {"expires_in_s", lasts.count()}});
}

HttpAnswer AccessApi::make_token(const HttpRequest& request, const Visitor&, const std::string&) {
  BodyFields body(request);
  const std::string name = body.text("name");
  const auto role = role_in(body);
  if (const auto problem = body.problem()) return *problem;
  if (!role) return error_answer(422, kRoles);
  const Admission admission = access_.make_token(name, *role, AccessTime::now());
  if (admission.status != 200) return refusal_of(admission);
  return with_json(201, {{"id", admission.credential.id},
                         {"name", admission.credential.name},
                         {"role", to_string(*role)},
                         {"token", admission.secret}});
}

HttpAnswer AccessApi::revoke(const HttpRequest&, const Visitor&, const std::string& id) {
  const Judgement done = access_.revoke(id);
  if (done.status != 200) return error_answer(done.status, done.why);
  HttpAnswer answer;
  answer.status = 204;
  return answer;
}

}  // namespace dynslam
