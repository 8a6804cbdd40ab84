#pragma once
/// Memory for tables that are filled once. Writing zeros first, by one thread, would touch all of its pages.

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
  void construct(Element* place) noexcept(noexcept(::new (static_cast<void*>(place)) Element)) {
    ::new (static_cast<void*>(place)) Element;
  }
  template <class Element, class... Arguments>
  void construct(Element* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) Element(std::forward<Arguments>(arguments)...);
  }
};

}  // namespace gonio
