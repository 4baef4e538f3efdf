#pragma once
// The ids of a scene and the <ref>s to them.

#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "patina/core/properties.h"
#include "patina/io/located_text.h"

namespace patina::io {

class SceneReferences {
  public:
    // Throws Error(input) when the id is taken.
    void define(const std::string& id, const std::shared_ptr<Properties>& node, const SourceLocation& where);
    void define_alias(const LocatedText& id, const LocatedText& as);

    // Leaves an empty child in `parent` for the node called `id`.
    void refer(Properties& parent, const std::string& name, const std::string& id, const SourceLocation& where);

    // Fills the children left empty. Throws Error(input) for an id nobody has, for a node that would contain itself and
    // for a tree that unfolds beyond reason.
    void resolve(const Properties& root);

  private:
    struct Reference {
        Properties* parent;
        std::size_t child;
        std::string id;
        SourceLocation where;
    };
    struct Extent {
        bool open = true;  // being visited
        int height = 1;
        double nodes = 1;  // with every reference unfolded
    };

    Extent measure(const Properties& node, int depth);
    const std::shared_ptr<Properties>& target(const Reference& reference) const;

    std::unordered_map<std::string, std::shared_ptr<Properties>> nodes_;
    std::vector<Reference> references_;
    std::unordered_map<const Properties*, std::vector<const Reference*>> by_parent_;
    std::unordered_map<const Properties*, Extent> extents_;
};

}  // namespace patina::io
