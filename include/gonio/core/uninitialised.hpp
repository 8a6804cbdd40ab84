#pragma once
/// Memory for tables that are filled once. Writing zeros first, by one thread, would touch all pages of a table.

#include <memory>
#include <utility>

namespace gonio {

/// The standard allocator, except that a vector constructed from a size alone has uninitialised elements.
template <class T>
struct uninitialised_allocator : std::allocator<T> {
  template <class Other>
  struct rebind {
    using other = uninitialised_allocator<Other>;
  };

  using std::allocator<T>::allocator;

  template <class Element>
  void construct(Element* element) noexcept(noexcept(::new (static_cast<void*>(element)) Element)) {
    ::new (static_cast<void*>(element)) Element;
  }
  template <class Element, class... Arguments>
  void construct(Element* element, Arguments&&... arguments) {
    ::new (static_cast<void*>(element)) Element(std::forward<Arguments>(arguments)...);
  }
};

}  // namespace gonio
