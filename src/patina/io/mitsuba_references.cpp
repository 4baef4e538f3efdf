#include "patina/io/mitsuba_references.h"

#include <algorithm>

#include <fmt/format.h>

namespace patina::io {

namespace {

// Far above what scenes nest, far below what a stack or a patient person holds.
constexpr int deepest_tree = 200;
constexpr double most_unfolded_nodes = 1e7;

}  // namespace

void SceneReferences::define(const std::string& id, const std::shared_ptr<Properties>& node,
                             const SourceLocation& where) {
    const auto [taken, added] = nodes_.emplace(id, node);
    if (!added)
        throw input_error(where, fmt::format("id {} is given twice", in_quotes(id)),
                          fmt::format("first at {}", taken->second->where.to_string()));
}

void SceneReferences::define_alias(const LocatedText& id, const LocatedText& as) {
    const auto found = nodes_.find(id.text);
    if (found == nodes_.end())
        throw input_error(id.where, fmt::format("there is no id {} above this alias", in_quotes(id.text)));
    define(as.text, found->second, as.where);
}

void SceneReferences::refer(Properties& parent, const std::string& name, const std::string& id,
                            const SourceLocation& where) {
    references_.push_back({&parent, parent.children.size(), id, where});
    parent.children.push_back({name, nullptr});
}

const std::shared_ptr<Properties>& SceneReferences::target(const Reference& reference) const {
    const auto found = nodes_.find(reference.id);
    if (found != nodes_.end()) return found->second;
    constexpr std::size_t most_listed = 40;
    std::vector<std::string> ids;
    for (const auto& [id, node] : nodes_) {
        if (ids.size() == most_listed) break;
        ids.push_back(id);
    }
    std::sort(ids.begin(), ids.end());
    throw input_error(reference.where, fmt::format("no element has the id {}", in_quotes(reference.id)), "",
                      did_you_mean(reference.id, ids));
}

SceneReferences::Extent SceneReferences::measure(const Properties& node, int depth) {
    const auto [known, first_visit] = extents_.emplace(&node, Extent{});
    if (!first_visit && known->second.open)
        throw input_error(node.where, fmt::format("{} {} contains itself", node.category, in_quotes(node.id)),
                          "its references lead back to it");
    if (!first_visit) return known->second;
    if (depth > deepest_tree)
        throw input_error(node.where, "elements and references are nested too deeply",
                          fmt::format("at most {} levels are", deepest_tree));

    Extent extent;
    const auto include = [&](const Properties& child) {
        const Extent inner = measure(child, depth + 1);
        extent.height = std::max(extent.height, inner.height + 1);
        extent.nodes += inner.nodes;
    };
    for (const auto& child : node.children)
        if (child.node) include(*child.node);
    if (const auto own = by_parent_.find(&node); own != by_parent_.end())
        for (const Reference* reference : own->second) include(*target(*reference));

    // A chain of references is as deep as a nest, and doubling references grow like 2^n.
    if (extent.height > deepest_tree || extent.nodes > most_unfolded_nodes)
        throw input_error(
            node.where, "the scene unfolds beyond reason",
            fmt::format("{} levels, {:.0f} nodes with every reference unfolded", extent.height, extent.nodes));
    extent.open = false;
    return extents_[&node] = extent;
}

void SceneReferences::resolve(const Properties& root) {
    for (const Reference& reference : references_) by_parent_[reference.parent].push_back(&reference);

    // Look at the whole graph first: a cycle of shared pointers would never be freed.
    measure(root, 1);
    for (const Reference& reference : references_) reference.parent->children[reference.child].node = target(reference);
}

}  // namespace patina::io
