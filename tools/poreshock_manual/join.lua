-- Puts the pages named in the metadata `pages` one after the other. Links between pages become links inside the
-- document, links to other files of the sources become plain text.

local function folder_of(path)
  return path:match("^(.*/)") or ""
end

-- The path that `target` means in a page of this folder, without "." and "..".
local function resolved(folder, target)
  local parts = {}
  for part in (folder .. target):gmatch("[^/]+") do
    if part == ".." then
      table.remove(parts)
    elseif part ~= "." then
      table.insert(parts, part)
    end
  end
  return table.concat(parts, "/")
end

local function identifier(path, anchor)
  local page = path:gsub("[/.]", "-")
  return anchor and anchor ~= "" and page .. "--" .. anchor or page
end

-- The blocks of a page, with identifiers of its own.
local function read_page(path, known)
  local file = assert(io.open(path))
  local page = pandoc.read(file:read("a"), "gfm+tex_math_dollars")
  file:close()
  local folder = folder_of(path)
  return pandoc.walk_block(pandoc.Div(page.blocks), {
    Header = function(header)
      header.identifier = identifier(path, header.level > 1 and header.identifier or nil)
      return header
    end,
    Link = function(link)
      if link.target:match("^%a+:") then return link end
      local file_name, anchor = link.target:match("^([^#]*)#?(.*)$")
      local target = file_name == "" and path or resolved(folder, file_name)
      if not known[target] then return link.content end
      link.target = "#" .. identifier(target, anchor)
      return link
    end,
    Image = function(image)
      image.src = resolved(folder, image.src)
      return image
    end,
  }).content
end

function Pandoc(document)
  local known, order = {}, {}
  for path in pandoc.utils.stringify(document.meta.pages):gmatch("%S+") do
    known[path] = true
    table.insert(order, path)
  end
  for _, path in ipairs(order) do
    document.blocks:extend(read_page(path, known))
  end
  return document
end
