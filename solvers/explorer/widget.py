"""The page in a notebook, which tells Python what it shows."""

from typing import Any

_MODULE = """
export default {
  render({ model, el }) {
    const frame = document.createElement("iframe");
    frame.title = "Collisions of the scene";
    frame.style.cssText = "width:100%;height:900px;border:1px solid rgba(128,128,128,.35)";
    frame.srcdoc = model.get("html");
    const told = (event) => {
      if (event.source !== frame.contentWindow || !event.data?.wetdoublet) return;
      for (const name of ["address", "toml"]) model.set(name, event.data.wetdoublet[name]);
      model.save_changes();
    };
    addEventListener("message", told);
    el.append(frame);
    return () => removeEventListener("message", told);
  },
};
"""


def widget(html: str) -> Any:
    """A page as an anywidget with the traits `address` and `toml`; None if anywidget is not installed."""
    try:
        import anywidget
        import traitlets
    except ImportError:
        return None
    traits = {
        name: traitlets.Unicode(html if name == "html" else "").tag(sync=True) for name in ("html", "address", "toml")
    }
    return type("ExplorerWidget", (anywidget.AnyWidget,), {"_esm": _MODULE, "__module__": __name__, **traits})()
